"""The Python module: wrong arguments are named in a line, and a refused call of a batch changes nothing."""

import copy
import math

import numpy
import plumb
import pytest


def says(call, *words):
    with pytest.raises(TypeError) as caught:
        call()
    text = str(caught.value)
    assert "\n" not in text and "Invoked" not in text
    for word in words:
        assert word in text, text


def test_unknown_keywords_are_named_and_the_valid_ones_listed():
    world = plumb.World()
    says(lambda: plumb.World(sleping=True), "World(): sleping is not an argument", "gravity", "sleeping")
    says(lambda: world.create_body(plumb.Circle(1), colour="red"), "create_body(): colour is not", "shapes", "angular_velocity")
    says(lambda: plumb.ShapeDefinition(plumb.Circle(1), bounce=1), "bounce", "restitution")
    says(lambda: world.create_body().create_chain([(0, 0), (1, 0)], frictoin=1), "frictoin", "friction")
    says(lambda: plumb.Simulation.realtime({}, steps=4), "realtime(): steps", "substeps")
    says(lambda: plumb.Circle(), "Circle(): radius is missing")
    says(lambda: plumb.Circle(1, 2), "2 arguments by position, of which it takes 1")
    says(lambda: plumb.Circle(1, radius=2), "radius is given twice")
    says(lambda: plumb.Revolute(anchor=(0, 0)), "anchor is not", "anchor_a")


def test_mistyped_arguments_are_named_with_value_and_type():
    world = plumb.World()
    body = world.create_body(plumb.Circle(1))
    says(lambda: world.create_body(position=1), "position is 1: must be two numbers, (x, y)")
    says(lambda: world.create_body(angle="x"), "angle is 'x': must be a number")
    says(lambda: world.create_body(name=5), "name is 5: must be a text")
    says(lambda: world.create_body([plumb.Circle(1), 5]), "shapes is [", "a plumb.ShapeDefinition", "a list of")
    says(lambda: world.create_body(user_data=-1), "user_data is -1: must be from 0 to 18446744073709551615")
    says(lambda: world.step(substeps=2.5), "substeps is 2.5: must be a whole number")
    says(lambda: world.create_joint(body, None, plumb.Weld()), "b is None: must be a plumb.Body")
    says(lambda: setattr(body, "velocity", 3), "velocity is 3: must be two numbers")
    says(lambda: setattr(world, "thresholds", (1, 2)), "thresholds is (1, 2): must be a list of 3 of a number")
    says(lambda: setattr(body, "user_data", 2**64), "user_data is 18446744073709551616: must be from 0")
    says(lambda: world.ray_cast((0, 0), "ab"), "translation is 'ab'")
    says(lambda: world.apply_law(5), "law is 5: must be a function")
    says(lambda: world.on_filter(5), "filter is 5: must be a function")
    says(lambda: world.ray_casts("a"), "rays is 'a': must be an array of numbers")
    says(lambda: plumb.Batch(world, 2, [body]).step("abc"), "actions is 'abc': must be an array of numbers or None")
    assert world.counts["bodies"] == 1


@pytest.mark.parametrize("wrong", [1, 0, None, "yes", 0.5, [], numpy.int64(1)])
def test_what_is_true_or_false_takes_nothing_else(wrong):
    world = plumb.World()
    body = world.create_body(plumb.Circle(1))
    shape, definition = body.shapes[0], plumb.ShapeDefinition(plumb.Circle(1))
    for call in (lambda: plumb.World(sleeping=wrong), lambda: world.create_body(awake=wrong),
                 lambda: setattr(body, "enabled", wrong), lambda: setattr(shape, "sensor", wrong),
                 lambda: setattr(definition, "sensor", wrong), lambda: body.set_locks(x=wrong),
                 lambda: world.shapes_at((0, 0), sensors=wrong), lambda: world.apply_wind((1, 0), wakes=wrong),
                 lambda: world.set_sleeping(wrong), lambda: setattr(world, "continuous", wrong)):
        says(call, "must be True or False")


def test_numpy_s_true_and_false_are_taken():
    world = plumb.World(sleeping=numpy.bool_(False))
    body = world.create_body(plumb.Circle(1), lock_x=numpy.bool_(True))
    assert (world.sleeping, body.locks) == (False, (True, False, False))
    batch = plumb.Batch(world, 2, [body])
    batch.reset(numpy.array([True, False]))


def test_a_user_s_type_error_stays_as_it_is():
    world = plumb.World()
    world.create_body(plumb.Circle(1))
    with pytest.raises(TypeError, match="^mine$"):
        world.apply_law(lambda body: (_ for _ in ()).throw(TypeError("mine")))


def test_any_bytes_can_be_restored():
    world = plumb.World()
    world.create_body(plumb.Circle(1))
    saved, before = world.save(), world.full_hash()
    for given in (saved, bytearray(saved), memoryview(saved), numpy.frombuffer(saved, numpy.uint8)):
        world.step()
        world.restore(given)
        assert world.full_hash() == before
    says(lambda: world.restore("text"), "bytes is 'text': must be bytes")
    says(lambda: world.restore(None), "bytes is None")
    simulation = plumb.Simulation.realtime({"bodies": []})
    simulation.restore(bytearray(simulation.save()))


@pytest.mark.parametrize("number", [math.nan, math.inf, -math.inf, numpy.float64("nan")])
def test_scenes_with_numbers_that_are_not_finite_name_body_and_field(number):
    ball = {"name": "ball", "position": [0, 1], "mass": 1, "shapes": [{"type": "circle", "radius": 0.5}]}

    def refused(scene, subject, field):
        for call in (plumb.World().add_scene, plumb.Simulation.realtime):
            with pytest.raises(plumb.InvalidValue) as caught:
                call(scene)
            assert (caught.value.subject, caught.value.field, caught.value.value) == (subject, field, repr(float(number)))

    for field, value in (("mass", number), ("angle", number)):
        refused({"bodies": [ball | {field: value}]}, "body 'ball'", field)
    refused({"bodies": [ball, ball | {"position": numpy.array([0, number])}]}, "body 'ball'", "position[1]")
    refused({"bodies": [{"position": [number, 0]}]}, "body 0", "position[0]")
    inner = copy.deepcopy(ball)
    inner["shapes"][0]["radius"] = number
    refused({"bodies": [inner]}, "body 'ball'", "shapes[0].radius")
    refused({"gravity": [0, number]}, "scene", "gravity[1]")


def test_objects_can_be_read():
    assert repr(plumb.Circle(0.5)) == "plumb.Circle(radius=0.5)"
    assert repr(plumb.Box(1, 2)) == "plumb.Box(width=1.0, height=2.0)"
    definition = plumb.ShapeDefinition(plumb.Capsule((0, 0), (1, 0), 0.25), friction=0.75, sensor=True)
    assert repr(eval(repr(definition))) == repr(definition) and "friction=0.75" in repr(definition)
    polygon = plumb.Polygon([(0, 0), (1, 0), (0, 1)])
    assert eval(repr(polygon)).points == polygon.points
    world = plumb.World(precision="double")
    world.create_body(plumb.Circle(1))
    world.step()
    assert repr(world) == "<plumb.World, double: 1 bodies, 0 joints, step 1>"


def test_everything_has_a_docstring():
    bare = []
    for name, made in vars(plumb).items():
        for member, value in vars(made).items() if isinstance(made, type) and not issubclass(made, (BaseException, dict)) else ():
            text = (getattr(value, "__doc__", None) or "").strip()
            lines = [line for line in text.splitlines() if not line.startswith(f"{member}(")]
            if not member.startswith("_") and not "".join(lines).strip():
                bare.append(f"{name}.{member}")
    assert bare == []


def batch_of(bodies=2, worlds=3):
    world = plumb.World(gravity=(0, 0))
    made = [world.create_body(plumb.Circle(0.5), position=(3 * i, 0)) for i in range(bodies)]
    return world, made, plumb.Batch(world, worlds, made, threads=2)


@pytest.mark.parametrize("wrong", [math.nan, math.inf, -math.inf, 2e12])
def test_a_refused_step_of_a_batch_changes_no_world(wrong):
    _, _, batch = batch_of()
    before = [batch.world(i).full_hash() for i in range(3)]
    for place, words in (((2, 1, 0), "actions[2, 1, 0], force x of world 2"), ((0, 0, 2), "actions[0, 0, 2], torque of world 0")):
        actions = numpy.ones((3, 2, 3))
        actions[place] = wrong
        with pytest.raises(plumb.InvalidValue) as caught:
            batch.step(actions)
        assert caught.value.field == words
        assert [batch.world(i).full_hash() for i in range(3)] == before
    for options in ({"dt": -1}, {"substeps": 0}, {"substeps": 1001}, {"dt": math.nan}, {"count": -1}):
        with pytest.raises(plumb.InvalidValue):
            batch.step(numpy.ones((3, 2, 3)), **options)
        assert [batch.world(i).full_hash() for i in range(3)] == before
    batch.world(2).bodies[1].destroy()
    after = [batch.world(i).full_hash() for i in range(3)]
    with pytest.raises(plumb.UnknownName):
        batch.step(numpy.ones((3, 2, 3)))
    assert [batch.world(i).full_hash() for i in range(3)] == after


def test_a_batch_refuses_bodies_twice_and_threads_that_no_world_has():
    world, (a, b), _ = batch_of()
    with pytest.raises(plumb.InvalidValue, match="twice") as caught:
        plumb.Batch(world, 2, [a, b, a])
    assert caught.value.value == str(a.index)
    for threads in (0, -1, 100000):
        with pytest.raises(plumb.InvalidValue) as caught:
            plumb.Batch(world, 2, [a], threads=threads)
        assert (caught.value.field, caught.value.value) == ("threads", str(threads))
        with pytest.raises(plumb.InvalidValue):
            plumb.World(threads=threads)


def test_settings_lists_and_chains_that_other_languages_have():
    world = plumb.World()
    for name, value in (("sleeping", False), ("continuous", False), ("direct_islands", False), ("quarantine", False), ("iterations", 7)):
        assert getattr(world, name) != value
        setattr(world, name, value)
        assert getattr(world, name) == value
    with pytest.raises(plumb.InvalidValue):
        world.iterations = 0
    world.quarantine = True
    ball, still = world.create_body(plumb.Circle(0.5)), world.create_body(plumb.Circle(1), type="static", position=(9, 9))
    world.step()
    assert ball in world.moved and still not in world.moved
    world.apply_law(lambda body: (math.nan, 0, 0))
    fault, = world.quarantined
    assert (fault["body"], fault["field"], fault["step"]) == (ball, "force", 2) and math.isnan(fault["value"])
    ball.release()
    assert world.quarantined == []
    options = dict(friction=0.25, restitution=0.5, rolling_resistance=0.125, surface_speed=2, category=2, mask=6, group=-3, sensor=True,
                   hit_events=True, pre_solve=True, user_data=9)
    segment = still.create_chain([(0, 0), (-1, 0), (-2, 0)], **options).segments[0]
    assert all(getattr(segment.definition, name) == value for name, value in options.items())
