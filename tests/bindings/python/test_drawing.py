"""The Python module: a world draws to functions, also between two steps; queries, movers and blasts ask a condition."""

import gc
import math
import weakref

import numpy
import plumb
import pytest


class Items:
    """Keeps what is drawn."""

    def __init__(self):
        self.all = []

    def polygon(self, corners, radius, role):
        self.all.append(("polygon", len(corners), radius, role))

    def circle(self, centre, radius, axis, role):
        self.all.append(("circle", centre, radius, role))

    def segment(self, start, end, role):
        self.all.append(("segment", start, end, role))

    def text(self, point, text, role):
        self.all.append(("text", point, text, role))

    other = 5  # not asked for


def falling():
    world = plumb.World()
    world.create_body(plumb.Box(40, 2), type="static", position=(0, -1))
    ball = world.create_body(plumb.Circle(0.5), position=(0, 4), name="Bäll")
    return world, ball


def test_a_world_draws_to_the_functions_that_there_are():
    world, ball = falling()
    rod = world.create_body(plumb.Capsule((0, 0), (1, 0), 0.2), position=(5, 5))
    world.create_joint(ball, rod, plumb.Distance(length=5))
    items = Items()
    world.draw(items, names=True)
    assert ("polygon", 4, 0.0, "static") in items.all
    assert ("circle", (0, 4), 0.5, "awake") in items.all
    assert [item[2] for item in items.all if item[0] == "text"] == ["Bäll"]
    assert any(item[-1] == "joint" for item in items.all) and not any(item[0] == "capsule" for item in items.all)
    near = Items()
    world.draw(near, joints=False, bounds=((-1, 3), (1, 5)))
    assert near.all == [("circle", (0, 4), 0.5, "awake")]
    only = type("Only", (), {"capsule": staticmethod(lambda *item: only.append(item))})
    only.append, kept = (lambda item: kept.append(item)), []
    world.draw(only)
    assert kept == [((5, 5), (6, 5), pytest.approx(0.2), "awake")]


def test_what_cannot_draw_is_refused():
    world, _ = falling()
    for wrong in (None, 5, object(), {"circle": print}):
        with pytest.raises(TypeError, match="none of the functions polygon, circle"):
            world.draw(wrong)
    with pytest.raises(TypeError, match="circle of what draws is 5"):
        world.draw(type("Wrong", (), {"circle": 5}))
    with pytest.raises(TypeError, match="shapes is 1"):
        world.draw(Items(), shapes=1)
    with pytest.raises(plumb.InvalidValue, match="fraction"):
        world.draw(Items(), fraction=math.nan)
    other = plumb.PastPoses(plumb.World())
    with pytest.raises(plumb.InvalidValue, match="another world"):
        world.draw(Items(), past=other)


def test_functions_that_draw_read_and_change_nothing():
    world, ball = falling()
    seen = []

    class Meddler:
        def circle(self, *_):
            seen.append(ball.position)
            for change in (world.step, ball.destroy, lambda: ball.shapes[0].set_geometry(plumb.Circle(1))):
                with pytest.raises(plumb.Unsupported):
                    change()
            world.draw(Items())
            raise LookupError("mine")

    before = world.full_hash()
    with pytest.raises(LookupError, match="mine"):
        world.draw(Meddler())
    assert seen == [(0, 4)] and world.full_hash() == before
    world.step()


def test_poses_between_two_steps():
    world, ball = falling()
    past = plumb.PastPoses(world)
    ball.velocity, ball.angular_velocity = (3, 0), 1
    before = world.poses[ball.index]
    world.step()
    after = world.poses[ball.index]
    late = world.create_body(plumb.Circle(1), position=(9, 9))
    for fraction in (0, 0.25, 1, 1.5):
        poses = past.at(fraction)
        assert poses.shape == (3, 3)
        assert numpy.allclose(poses[ball.index], before + fraction * (after - before), atol=1e-12)
        assert tuple(poses[late.index]) == (9, 9, 0)
    items = Items()
    world.draw(items, past=past, fraction=0.5)
    centre = next(item[1] for item in items.all if item[0] == "circle")
    assert numpy.allclose(centre, (before + 0.5 * (after - before))[:2])
    ball.destroy()
    assert numpy.isnan(past.at(0.5)[ball.index]).all()
    with pytest.raises(plumb.InvalidValue, match="fraction"):
        past.at(math.inf)


# Functions that draw may let go of what is drawn: the call has it still.
def test_poses_that_are_let_go_while_they_are_drawn_stay_to_its_end():
    held = {}
    world, ball = falling()
    held["world"], held["past"] = world, plumb.PastPoses(world)
    gone = weakref.ref(held["world"]) if hasattr(plumb.World, "__weakref__") else None
    del world, ball
    calls = []

    class Dropper:
        def polygon(self, *_):
            held["past"].keep()
            held.clear()
            gc.collect()
            calls.append("polygon")

        def circle(self, *_):
            calls.append("circle")

    held["world"].draw(Dropper(), past=held["past"], fraction=0.5)
    assert calls == ["polygon", "circle"]
    assert gone is None or gone() is None


def test_queries_ask_a_condition():
    world = plumb.World(gravity=(0, 0))
    near, far = (world.create_body(plumb.Circle(0.5), position=(x, 0)) for x in (2, 5))
    only_far = lambda shape: shape.body == far  # noqa: E731
    assert world.ray_cast((0, 0), (9, 0), condition=only_far)["body"] == far
    assert [hit["body"] for hit in world.ray_cast_all((0, 0), (9, 0), condition=only_far)] == [far]
    assert world.cast_shape(plumb.Circle(0.1), (0, 0), 0, (9, 0), condition=only_far)["body"] == far
    assert world.overlap_box((0, -1), (9, 1), condition=only_far) == far.shapes
    assert world.overlap_shape(plumb.Circle(9), (0, 0), condition=only_far) == far.shapes
    assert world.shapes_at((2, 0), condition=only_far) == []
    assert world.nearest((0, 0), 9, condition=only_far)["body"] == far
    assert world.ray_cast((0, 0), (9, 0), condition=None)["body"] == near
    with pytest.raises(TypeError, match="a condition must return True or False, not None"):
        world.ray_cast((0, 0), (9, 0), condition=lambda shape: None)
    with pytest.raises(TypeError, match="condition is 5"):
        world.ray_cast((0, 0), (9, 0), condition=5)

    def meddles(shape):
        with pytest.raises(plumb.Unsupported):
            world.step()
        raise LookupError("mine")

    with pytest.raises(LookupError, match="mine"):
        world.ray_cast((0, 0), (9, 0), condition=meddles)
    world.step()


def test_a_mover_passes_what_its_filter_leaves_out_and_tells_what_stopped_it():
    world = plumb.World()
    world.create_body(plumb.Box(40, 2), type="static", position=(0, -1))
    wall = world.create_body(plumb.ShapeDefinition(plumb.Box(1, 4), category=2), type="static", position=(2, 2))
    capsule = plumb.Capsule((0, 0.5), (0, 1.5), 0.5)
    go = lambda **filters: world.move(capsule, (0, 0.02), (6, 0), 0.5, **filters)  # noqa: E731
    stopped = go()
    assert stopped["position"][0] < 1.01 and wall in [hit["body"] for hit in stopped["hits"]]
    assert {"shape", "body", "point", "normal", "impulse"} == set(stopped["hits"][0])
    for filters in ({"ignore": wall}, {"mask": ~2 & (2**64 - 1)}, {"condition": lambda shape: shape.body != wall}):
        assert go(**filters)["position"][0] == pytest.approx(3, abs=0.05), filters


def test_what_hides_from_a_blast_is_chosen():
    def pushed(**cover):
        world = plumb.World(gravity=(0, 0))
        shield = world.create_body(plumb.ShapeDefinition(plumb.Box(0.2, 4), category=2), type="static", position=(1, 0))
        behind = world.create_body(plumb.Box(1, 1), position=(2, 0))
        world.explode((0, 0), radius=5, impulse=1, occlusion=True, **{k: v(shield) for k, v in cover.items()})
        return behind.velocity[0] > 0

    assert not pushed()
    assert pushed(ignore=lambda shield: shield)
    assert pushed(mask=lambda shield: ~2 & (2**64 - 1))
    assert pushed(condition=lambda shield: lambda shape: shape.body != shield)
