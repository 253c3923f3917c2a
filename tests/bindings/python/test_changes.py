"""The Python module: geometry is replaced, segments have materials, and definitions read back."""

import math

import plumb
import pytest


def at_rest(**of_shape):
    world = plumb.World()
    ground = world.create_body(plumb.Box(40, 2), type="static", position=(0, -1))
    body = world.create_body(plumb.ShapeDefinition(plumb.Box(1, 1), **of_shape), position=(0, 0.5))
    world.step(count=90)
    assert not body.awake
    return world, ground, body


def test_the_geometry_of_a_shape_is_replaced_and_all_else_stays():
    world, ground, body = at_rest(density=2, friction=0.25, category=4, hit_events=True, user_data=9)
    shape, floor = body.shapes[0], ground.shapes[0]
    shape.set_geometry(plumb.Capsule((0, 0), (1, 0), 0.5), position=(0, 1))
    assert shape.valid and body.awake
    now = shape.definition
    assert now.geometry.start == (0, 1) and now.geometry.radius == 0.5
    assert (now.density, now.friction, now.category, now.hit_events, now.user_data) == (2, 0.25, 4, True, 9)
    assert body.mass == pytest.approx(2 * (1 + math.pi / 4), rel=1e-6)
    floor.set_geometry(plumb.Polygon([(-20, 0), (20, 0), (0, -3)]), (0, 0.25), 0)
    assert floor.box[1] == (20, -0.75)
    before = world.full_hash()
    for wrong, field in ((plumb.Box(1, -1), "height"), (plumb.Circle(math.nan), "radius"), (plumb.Segment((0, 0), (0, 0)), "end")):
        with pytest.raises(plumb.InvalidValue) as caught:
            shape.set_geometry(wrong)
        assert caught.value.field == field and caught.value.subject == "shape 1 of body 1"
    with pytest.raises(TypeError, match="geometry is 5"):
        shape.set_geometry(5)
    assert world.full_hash() == before


def test_a_shape_that_is_replaced_ends_its_contact_and_begins_it_anew():
    world, ground, body = at_rest()
    ground.shapes[0].set_geometry(plumb.Box(30, 2))
    world.step()
    assert len(world.events["end"]) == len(world.events["begin"]) == 1
    assert world.events["begin"][0] == (ground.shapes[0], body.shapes[0])


def test_segments_of_a_chain_have_their_own_materials():
    world = plumb.World()
    ground = world.create_body(type="static")
    points = [(4, 0), (0, 0), (-4, 0)]
    materials = [plumb.Material(0, restitution=0.5), plumb.Material(0.75, surface_speed=2)]
    chain = ground.create_chain(points, materials=materials, user_data=3)
    assert [segment.material for segment in chain.segments] == materials
    assert chain.segments[1].surface_speed == 2
    definition = chain.definition
    assert definition["points"] == points and definition["materials"] == materials and definition["user_data"] == 3
    again = ground.create_chain(**definition)
    assert again.definition == definition
    even = ground.create_chain(points, friction=0.25, closed=True).definition
    assert even["friction"] == 0.25 and even["materials"] == [] and even["closed"]
    with pytest.raises(plumb.InvalidValue, match="one per segment"):
        ground.create_chain(points, materials=materials[:1])
    with pytest.raises(plumb.InvalidValue, match="segment of a chain"):
        chain.segments[0].set_geometry(plumb.Circle(1))
    belt = chain.segments[0]
    belt.material = plumb.Material(surface_speed=3)
    assert belt.surface_speed == 3 and belt.friction == pytest.approx(0.6, rel=1e-6)
    assert "surface_speed=3" in repr(belt.material)


def test_the_contact_of_a_begin_event_is_found_by_its_shapes():
    world = plumb.World()
    world.create_body(plumb.Box(40, 2), type="static", position=(0, -1))
    ball = world.create_body(plumb.ShapeDefinition(plumb.Circle(0.5), hit_events=True), position=(0, 0.6))
    begun = 0
    for _ in range(30):
        world.step()
        for a, b in world.events["begin"]:
            contact = a.contact(b)
            assert contact == b.contact(a)
            assert contact["shape_a"] == a and contact["step_impulse"] > 0
            assert contact["points"][0][1] == pytest.approx(0, abs=0.02)
            begun += 1
    assert begun == 1
    assert ball.shapes[0].contact(ball.shapes[0]) is None
    with pytest.raises(plumb.InvalidValue, match="another world"):
        ball.shapes[0].contact(plumb.World().create_body(plumb.Circle(1)).shapes[0])


def test_a_joint_reads_back_as_it_was_made():
    world = plumb.World()
    a, b = world.create_body(plumb.Circle(1)), world.create_body(plumb.Circle(1), position=(3, 0))
    joint = world.create_joint(a, b, plumb.Distance(length=3), collide=True, break_force=50, report_torque=2, user_data=4)
    definition = joint.definition
    assert definition["kind"].length == 3 and definition["collide"] and definition["break_force"] == 50
    assert (definition["report_torque"], definition["report_force"], definition["user_data"]) == (2, 0, 4)
    joint.destroy()
    kind = definition.pop("kind")
    assert world.create_joint(a, b, kind, **definition).definition["break_force"] == 50
