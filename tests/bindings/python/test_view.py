"""Pictures of worlds: each shape's outline lies where the engine has the shape."""

import math

import plumb
import pytest

matplotlib = pytest.importorskip("matplotlib", reason="install python3-matplotlib")
matplotlib.use("Agg")
import plumb.view  # noqa: E402

SHAPES = [plumb.Circle(0.5), plumb.Box(1, 0.4), plumb.Capsule((-0.5, 0), (0.3, 0.2), 0.2), plumb.Segment((0, 0), (1, 0.5)),
          plumb.Polygon([(0, 0), (1, 0), (0, 1)]), plumb.Polygon([(0, 0), (1, 0), (0, 1)], radius=0.2)]


@pytest.fixture(autouse=True)
def close_figures():
    yield
    matplotlib.pyplot.close("all")


@pytest.mark.parametrize("geometry", SHAPES, ids=lambda each: type(each).__name__)
def test_an_outline_fills_the_box_of_its_shape(geometry):
    world = plumb.World(gravity=(0, 0), precision="double")
    body = world.create_body(plumb.ShapeDefinition(geometry, position=(0.3, 0.1), angle=0.4), position=(2, 1), angle=0.7)
    view = plumb.view.draw(world)
    patch, = view.update()
    to_data = patch.get_transform() - view.axes.transData
    outline = to_data.transform(patch.get_path().vertices)
    (left, bottom), (right, top) = body.box
    # Arcs of 16 chords: 0.5 % of a radius below 0.5 m.
    assert (*outline.min(axis=0), *outline.max(axis=0)) == pytest.approx((left, bottom, right, top), abs=3e-3)


def test_a_view_follows_what_moves_comes_and_goes():
    world = plumb.World()
    ball = world.create_body(plumb.Circle(0.5), position=(0, 3))
    view = plumb.view.draw(world)
    patch, = view.update()
    world.step(count=30)
    view.update()
    x, y = (patch.get_transform() - view.axes.transData).transform((0, 0))
    assert (x, y) == pytest.approx(ball.position, abs=1e-9)
    other = world.create_body(plumb.Box(1, 1))
    assert len(view.update()) == 2
    other.enabled = False
    assert view.update() == [patch] and len(view.axes.patches) == 1


def test_an_animation_steps_the_world_once_at_its_own_speed(tmp_path):
    world, pushes = plumb.World(gravity=(0, 0)), []
    ball = world.create_body(plumb.Circle(0.5), velocity=(1, 0))
    animation = plumb.view.animate(world, seconds=0.5, fps=20, before_step=lambda: pushes.append(world.time), bounds=(-1, -1, 2, 1))
    page = animation.to_jshtml()
    assert page.count("data:image/png;base64") == 11
    assert world.time == pytest.approx(0.5) and len(pushes) == 30
    assert ball.position[0] == pytest.approx(0.5, rel=1e-6)


def test_turned_discs_show_how_far():
    world = plumb.World(gravity=(0, 0))
    world.create_body(plumb.Circle(0.5), angle=math.pi / 2)
    view = plumb.view.draw(world)
    patch, = view.update()
    first = (patch.get_transform() - view.axes.transData).transform(patch.get_path().vertices[:1])[0]
    assert tuple(first) == pytest.approx((0, 0.5), abs=1e-9)


def test_what_cannot_be_drawn_is_refused_by_name():
    world = plumb.World()
    for wrong in (None, 5, "world"):
        with pytest.raises(TypeError, match="must be a plumb.World"):
            plumb.view.draw(wrong)
    with pytest.raises(TypeError, match="axes"):
        plumb.view.draw(world, axes=5)
    with pytest.raises(TypeError, match="before_step"):
        plumb.view.animate(world, before_step=5)
    for bounds in (5, (0, 1, 2), (0, 0, 0, 1), (1, 0, 0, 1), (0, 0, math.nan, 1), ("a", 0, 1, 1)):
        with pytest.raises(plumb.InvalidValue) as caught:
            plumb.view.draw(world, bounds=bounds)
        assert caught.value.field == "bounds"
    for options in ({"seconds": math.nan}, {"seconds": 0}, {"fps": 0}, {"fps": "a"}, {"dt": -1}, {"dt": math.inf}):
        with pytest.raises(plumb.InvalidValue) as caught:
            plumb.view.animate(world, **options)
        assert caught.value.field == next(iter(options))
