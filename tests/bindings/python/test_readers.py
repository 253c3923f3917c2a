"""The Python module: what can be set can be read, and every query takes a filter."""

import math

import plumb
import pytest


def test_points_and_velocities_of_a_body():
    world = plumb.World(gravity=(0, 0), precision="double")
    body = world.create_body(plumb.Circle(0.5), position=(3, 4), angle=math.pi / 2, velocity=(1, 2), angular_velocity=2)
    assert body.local_point((3, 5)) == pytest.approx((1, 0), abs=1e-12)
    assert body.world_point(body.local_point((7, 9))) == pytest.approx((7, 9), abs=1e-12)
    # v + w x r
    assert body.velocity_at((3, 5)) == pytest.approx((1 - 2, 2), abs=1e-12)


def test_locks_are_read_as_they_were_set():
    world = plumb.World()
    body = world.create_body(plumb.Circle(0.5), lock_y=True)
    assert body.locks == (False, True, False)
    body.set_locks(x=True, rotation=True)
    assert body.locks == (True, False, True)


def test_materials_filters_and_owners_are_read():
    world = plumb.World()
    definition = plumb.ShapeDefinition(plumb.Circle(0.5), rolling_resistance=0.125, surface_speed=2, category=4,
                                       mask=1 << 63, group=-3)
    assert (definition.rolling_resistance, definition.surface_speed) == (0.125, 2)
    assert (definition.category, definition.mask, definition.group) == (4, 1 << 63, -3)
    body = world.create_body(definition)
    shape, = body.shapes
    assert shape.rolling_resistance == 0.125 and shape.filter == (4, 1 << 63, -3)
    shape.rolling_resistance = 0.25
    shape.set_filter(mask=7)
    assert shape.rolling_resistance == 0.25 and shape.filter == (1, 7, 0)
    assert (shape.definition.rolling_resistance, shape.definition.mask) == (0.25, 7)
    ground = world.create_body(type="static")
    chain = ground.create_chain([(3, 0), (2, 0), (1, 0), (0, 0)])
    assert chain.body == ground
    joint = world.create_joint(ground, body, plumb.Weld(), user_data=5)
    assert joint.user_data == 5
    joint.user_data = 1 << 63
    assert joint.user_data == 1 << 63


def test_the_distance_of_two_shapes():
    world = plumb.World(precision="double")
    a = world.create_body(plumb.Circle(1)).shapes[0]
    b = world.create_body(plumb.Box(2, 2), position=(4, 0)).shapes[0]
    found = a.distance(b)
    assert found["distance"] == pytest.approx(2, abs=1e-9)
    assert found["normal"] == pytest.approx((1, 0), abs=1e-9)
    assert (found["point_a"][0], found["point_b"][0]) == pytest.approx((1, 3), abs=1e-9)
    other = plumb.World().create_body(plumb.Circle(1)).shapes[0]
    with pytest.raises(plumb.InvalidValue, match="another world"):
        a.distance(other)


# Each asks about the line x = 0 to 9, y = 0, and returns the indices of the bodies that it finds.
QUERIES = {
    "ray_cast": lambda w, **k: indices([w.ray_cast((-5, 0), (20, 0), **k)]),
    "ray_cast_all": lambda w, **k: indices(w.ray_cast_all((-5, 0), (20, 0), **k)),
    "cast_shape": lambda w, **k: indices([w.cast_shape(plumb.Circle(0.1), (-5, 0), 0, (20, 0), **k)]),
    "overlap_shape": lambda w, **k: {s.body.index for s in w.overlap_shape(plumb.Box(20, 0.1), (0, 0), **k)},
    "overlap_box": lambda w, **k: {s.body.index for s in w.overlap_box((-5, -0.1), (15, 0.1), **k)},
    "shapes_at": lambda w, **k: {s.body.index for x in (0, 3, 6) for s in w.shapes_at((x, 0), **k)},
    "nearest": lambda w, **k: indices([w.nearest((-5, 0), 99, **k)]),
}
FIRST = ("ray_cast", "cast_shape", "nearest")  # find one alone


def indices(hits):
    return {hit["body"].index for hit in hits if hit}


@pytest.mark.parametrize("query", QUERIES)
def test_every_query_takes_a_filter(query):
    world = plumb.World()
    shapes = [plumb.ShapeDefinition(plumb.Circle(0.5), category=1 << i, mask=1 << (i + 8), sensor=i == 2)
              for i in range(3)]
    bodies = [world.create_body(shape, position=(3 * i, 0)) for i, shape in enumerate(shapes)]

    def found(**considered):
        return QUERIES[query](world, **considered)

    def expect(*all_of_them):
        return set(all_of_them[:1]) if query in FIRST else set(all_of_them)

    assert found() == expect(0, 1)
    assert found(sensors=True) == expect(0, 1, 2)
    assert found(mask=2) == {1} and found(mask=8) == set()
    assert found(category=1 << 9) == {1}
    assert found(ignore=bodies[0]) == {1}
    bodies[0].destroy()
    with pytest.raises(plumb.UnknownName, match="destroyed"):
        found(ignore=bodies[0])
