"""The Python module: wrong arguments and wrong results of hooks and laws raise typed errors, and nothing crashes."""

import ast
import pathlib
import subprocess
import sys

import numpy
import plumb
import pytest

# Functions that take a world, with another argument where they need one.
NONE_FOR_A_WORLD = [
    "plumb.Rollback(None, 5)", "plumb.Batch(None, 2, [])", "plumb.World.create_body(None)", "plumb.World.step(None)",
    "plumb.World.bodies.fget(None)", "plumb.World.events.fget(None)", "plumb.World.overlap_box(None, (0, 0), (1, 1))",
    "plumb.World.apply_linear_drag(None, 1.0)", "plumb.World.ray_cast(None, (0, 0), (1, 0))",
    "plumb.World().create_joint(None, None, plumb.Weld())", "plumb.Body.position.fget(None)",
    "plumb.Rollback.save(None)", "plumb.Batch.__len__(None)", "plumb.Batch.hashes(None)", "plumb.Batch.observe(None)",
    "plumb.Batch.step(None)", "plumb.Simulation.step(None)", "plumb.Simulation.hash(None)",
    "plumb.World().create_body([None])", "plumb.Batch(plumb.World(), 1, [None])",
]


@pytest.mark.parametrize("call", NONE_FOR_A_WORLD)
def test_none_where_an_object_belongs_is_a_type_error(call):
    # In a process of its own: a null pointer would end this one.
    program = f"import plumb\ntry:\n    {call}\nexcept TypeError:\n    print('refused')"
    run = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert (run.returncode, run.stdout) == (0, "refused\n"), run.stderr


def test_signatures_and_stubs_name_what_python_has():
    for name, made in vars(plumb).items():
        for member, value in vars(made).items() if isinstance(made, type) else ():
            assert "plumb::" not in (getattr(value, "__doc__", None) or ""), f"{name}.{member}"
    stub = ast.parse(pathlib.Path(plumb.__file__).with_name("__init__.pyi").read_text())
    missing = [each.name for each in stub.body if isinstance(each, (ast.ClassDef, ast.FunctionDef)) and not hasattr(plumb, each.name)]
    assert missing == []
    assert all("array" not in made.index.__doc__ for made in (plumb.Shape, plumb.Chain, plumb.Joint))


def test_a_character_in_the_air_has_no_ground():
    world = plumb.World()
    floor = world.create_body(plumb.Box(20, 2), type="static", position=(0, -1))
    capsule = plumb.Capsule((0, 0.3), (0, 1), 0.3)
    assert world.move(capsule, (0, 9), (0, 0), 1 / 60)["ground"] is None
    assert world.move(capsule, (0, 0.01), (0, -1), 1 / 60)["ground"] == floor


def test_scenes_may_have_numbers_and_arrays_of_numpy():
    scene = {"gravity": numpy.array([0, -4.0]), "bodies": [{"name": "a", "position": numpy.ones(2), "mass": numpy.float32(2),
                                                           "shapes": [{"type": "circle", "radius": numpy.float64(0.5)}]}]}
    assert plumb.World().add_scene(scene)["a"].position == (1, 1)
    assert plumb.Simulation.realtime(scene).state("a")["position"] == (1, 1)
    with pytest.raises(TypeError, match="scene"):
        plumb.World().add_scene({"bodies": [object()]})


def test_cases_that_are_none_are_a_type_error():
    for call in (lambda: plumb.compare(None), lambda: plumb.compare(5), lambda: plumb.tune(None)):
        with pytest.raises(TypeError, match="a case is"):
            call()


def two_bodies():
    world = plumb.World()
    return world, world.create_body(plumb.Circle(0.5)), world.create_body(plumb.Circle(0.5), position=(3, 0))


def refused(kind, field, value, call):
    with pytest.raises(kind) as caught:
        call()
    assert (caught.value.field, caught.value.value) == (field, value)
    assert caught.value.subject and caught.value.problem


def test_counts_out_of_range_are_refused():
    world, body, _ = two_bodies()
    refused(plumb.InvalidValue, "count", "-1", lambda: world.step(1 / 60, 4, -1))
    world.step(count=0)
    assert world.step_count == 0
    refused(plumb.InvalidValue, "threads", "0", lambda: plumb.Batch(world, 2, [body], threads=0))
    refused(plumb.InvalidValue, "count", "0", lambda: plumb.Batch(world, 0, [body]))
    batch = plumb.Batch(world, 2, [body])
    refused(plumb.InvalidValue, "count", "-1", lambda: batch.step(count=-1))
    for index in (2, -1):
        refused(plumb.UnknownName, "index", str(index), lambda: batch.world(index))
    assert batch.world(1).counts["bodies"] == 2


def test_handles_of_destroyed_bodies_are_refused():
    world, body, other = two_bodies()
    other.destroy()
    stale = f"{other.index} of generation "
    for call in (lambda: plumb.Batch(world, 2, [body, other]),
                 lambda: world.ray_cast((-5, 0), (9, 0), ignore=other),
                 lambda: world.cast_shape(plumb.Circle(1), (-5, 0), 0, (9, 0), ignore=other)):
        with pytest.raises(plumb.UnknownName, match="destroyed") as caught:
            call()
        assert (caught.value.subject, caught.value.field) == ("body", "handle")
        assert caught.value.value.startswith(stale)
    # A new body has the old one's row, and is not ignored in its place.
    again = world.create_body(plumb.Circle(0.5), position=(3, 0))
    assert again.index == other.index
    with pytest.raises(plumb.UnknownName):
        world.ray_cast((9, 0), (-9, 0), ignore=other)


def test_springs_and_distances_that_cannot_be():
    world, body, other = two_bodies()
    refused(plumb.InvalidValue, "b", str(body.index), lambda: world.apply_spring(body, (0, 0), body, (1, 0)))
    for wrong, field, value in (((-1, 1), "range.lower", "-1"), ((2, 1), "range.lower", "2")):
        kind = plumb.Distance(range=wrong)
        refused(plumb.InvalidValue, field, value, lambda: world.create_joint(body, other, kind))
    world.create_joint(body, other, plumb.Distance(range=(0, 4)))


@pytest.mark.parametrize("wrong", [None, 1.0, (1, 2), ("a", 0, 0), "abc", (0, 0, None)])
def test_a_law_that_returns_something_else_is_a_type_error(wrong):
    world, body, _ = two_bodies()
    before = world.full_hash()
    with pytest.raises(TypeError, match=r"a law must return \(x, y, torque\), three numbers, not "):
        world.apply_law(lambda body: wrong)
    assert world.full_hash() == before
    world.apply_law(lambda body: [1, 2, 0])


@pytest.mark.parametrize("wrong", [None, "yes", (), [True]])
@pytest.mark.parametrize("hook", ["on_pre_solve", "on_filter"])
def test_a_hook_that_returns_something_else_is_a_type_error(hook, wrong):
    world = plumb.World()
    world.create_body(plumb.ShapeDefinition(plumb.Box(9, 2), pre_solve=True), type="static", position=(0, -1))
    ball = world.create_body(plumb.Circle(0.5), position=(0, 0.5))
    getattr(world, hook)(lambda *given: wrong)
    with pytest.raises(TypeError, match=f"of {hook} must return True or False, not "):
        world.step()
    assert world.step_count == 0
    getattr(world, hook)(lambda *given: True)
    world.step(count=30)
    assert ball.position[1] == pytest.approx(0.5, abs=1e-3)


def test_a_snapshot_repeats_a_step_that_a_hook_has_thrown_out_of():
    world = plumb.World()
    world.create_body(plumb.ShapeDefinition(plumb.Box(20, 2), pre_solve=True), type="static", position=(0, -1))
    body = world.create_body(plumb.Box(1, 1), position=(0, 0.8), angle=0.5, velocity=(2, 0))
    world.on_pre_solve(lambda contact: True)
    world.step(count=20)
    saved, state = world.save(), (body.position, body.angle, body.velocity, body.angular_velocity)
    world.step()
    undisturbed = world.full_hash()
    world.restore(saved)
    world.on_pre_solve(lambda contact: 1 / 0)
    with pytest.raises(ZeroDivisionError):
        world.step()
    assert (body.position, body.angle, body.velocity, body.angular_velocity) == state
    world.on_pre_solve(lambda contact: True)
    world.restore(saved)
    world.step()
    assert world.full_hash() == undisturbed
