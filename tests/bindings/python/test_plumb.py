"""The Python module: against closed forms, and against what its own parts say of each other."""

import ast
import gc
import inspect
import math
import pathlib
import runpy
import threading

import numpy as np
import plumb
import pytest

G = 9.81
SCENE = {"name": "fall", "bodies": [{"name": "ball", "position": [0, 10], "mass": 1,
                                     "shapes": [{"type": "circle", "radius": 0.5}]}]}


def ground(world):
    return world.create_body(plumb.Box(40, 2), type="static", position=(0, -1))


def tower(world, count=5):
    return [world.create_body(plumb.Box(1, 1), position=(0.05 * i, 0.5 + i)) for i in range(count)]


@pytest.mark.parametrize("precision, tolerance", [("float", 2e-6), ("double", 1e-12)])
def test_a_body_in_free_flight_follows_its_parabola(precision, tolerance):
    world = plumb.World(precision=precision)
    body = world.create_body(plumb.Circle(0.5), position=(0, 10), velocity=(2, 1))
    world.step(1 / 60, count=60)
    assert world.time == pytest.approx(1, abs=1e-12)
    # Rounding of velocities near 10 m/s over 60 steps bounds the float's error.
    assert body.position == pytest.approx((2, 10 + 1 - G / 2), rel=tolerance)
    assert body.mass == pytest.approx(math.pi / 4, rel=1e-6)


def test_views_show_each_step_without_a_copy():
    world = plumb.World()
    ground(world), tower(world)
    centres, angles, velocities, spins = world.centres, world.angles, world.velocities, world.angular_velocities
    assert centres.shape == (6, 2) and angles.shape == (6,) and velocities.shape == (6, 2) and spins.shape == (6,)
    before = centres.copy()
    for _ in range(300):
        world.step()
    assert not np.array_equal(before, centres)
    for body in world.bodies:
        assert tuple(centres[body.index]) == body.centre
        assert angles[body.index] == body.angle
        assert tuple(map(float, velocities[body.index])) == body.velocity
        assert spins[body.index] == body.angular_velocity
    assert np.shares_memory(centres, world.centres)
    with pytest.raises(ValueError):
        centres[0] = 0


@pytest.mark.parametrize("change", ["create", "restore", "scene", "forget"])
def test_views_outlive_what_they_view(change):
    world = plumb.World()
    ground(world), tower(world)
    centres, angles, velocities = world.centres, world.angles, world.velocities
    kept = centres.copy(), angles.copy(), velocities.copy()
    saved = world.save()
    if change == "create":
        for _ in range(1000):
            world.create_body(plumb.Circle(0.1), position=(5, 5))
        assert world.centres.shape == (1006, 2)
    elif change == "restore":
        world.restore(saved)
    elif change == "scene":
        world.add_scene(SCENE)
    else:
        del world
        gc.collect()
    assert all(np.array_equal(a, b) for a, b in zip(kept, (centres, angles, velocities)))


def test_rows_of_destroyed_bodies_are_marked():
    world = plumb.World()
    bodies = [world.create_body(plumb.Circle(0.5), position=(i, 3)) for i in range(4)]
    bodies[1].destroy()
    assert list(world.used) == [True, False, True, True]
    poses = world.poses
    assert np.isnan(poses[1]).all() and tuple(poses[2]) == (2, 3, 0)
    assert [body.index for body in world.bodies] == [0, 2, 3]
    assert not bodies[1].valid
    with pytest.raises(plumb.UnknownName):
        bodies[1].position


def test_poses_are_of_origins_and_centres_of_centres():
    world = plumb.World()
    body = world.create_body(plumb.ShapeDefinition(plumb.Circle(0.5), position=(1, 0)), position=(3, 4), angle=math.pi / 2)
    assert world.poses[0] == pytest.approx((3, 4, math.pi / 2), abs=1e-6)
    assert world.centres[0] == pytest.approx((3, 5), abs=1e-6)
    assert body.position == pytest.approx((3, 4), abs=1e-6)


def test_contacts_are_one_array():
    world = plumb.World()
    ground(world), tower(world)
    world.step(count=120)
    contacts = world.contacts
    assert len(contacts) == 5
    assert (contacts["count"] == 2).all()
    # The lowest contact carries five boxes of 1 kg; impulses are those of a substep of 1/240 s.
    lowest = contacts[contacts["body_a"] == 0][0]
    assert lowest["impulses"].sum() == pytest.approx(5 * G / 240, rel=1e-3)


def test_a_body_of_another_world_is_refused():
    world, other = plumb.World(), plumb.World()
    other.create_body(plumb.Circle(1))
    foreign, own = other.create_body(plumb.Circle(1)), world.create_body(plumb.Circle(1))
    world.create_body(plumb.Circle(1), position=(5, 0))  # has the number of `foreign`
    with pytest.raises(plumb.InvalidValue, match="another world"):
        world.create_joint(own, foreign, plumb.Weld())
    with pytest.raises(plumb.InvalidValue, match="another world"):
        world.ray_cast((5, 5), (0, -9), ignore=foreign)
    assert world.counts["joints"] == 0


def test_casts_of_shapes_meet_every_category():
    world = plumb.World()
    world.create_body(plumb.ShapeDefinition(plumb.Circle(1), category=1 << 40))
    assert world.cast_shape(plumb.Circle(0.5), (0, 5), 0, (0, -9))["fraction"] == pytest.approx(3.5 / 9)


def test_errors_have_a_type_and_parts():
    world = plumb.World()
    with pytest.raises(plumb.InvalidValue, match="ball") as caught:
        world.create_body(plumb.Circle(-0.5), name="ball")
    assert isinstance(caught.value, ValueError) and isinstance(caught.value, plumb.Error)
    assert (caught.value.field, caught.value.value) == ("radius", "-0.5")
    assert world.counts["bodies"] == 0
    with pytest.raises(plumb.UnknownName, match="soft_steps"):
        plumb.World(solver="magic")
    with pytest.raises(plumb.SceneSyntaxError) as caught:
        plumb.scene_from_json('{\n"bodies": 3}')
    assert caught.value.line == 2
    with pytest.raises(TypeError):
        world.create_body(plumb.Circle(0.5), position=(1, 2, 3))


def test_save_and_restore_give_the_same_bits():
    world = plumb.World()
    ground(world), tower(world)
    world.step(count=30)
    saved = world.save()
    world.step(count=60)
    end = world.full_hash()
    world.restore(saved)
    world.step(count=60)
    assert world.full_hash() == end
    with pytest.raises(plumb.InvalidValue):
        world.restore(saved[:-1])
    assert world.full_hash() == end


def test_joints_motors_and_readings():
    world = plumb.World()
    base = world.create_body(type="static")
    wheel = world.create_body(plumb.Circle(0.5), position=(0, 3))
    joint = world.create_joint(base, wheel, plumb.Revolute(anchor_a=(0, 3), motor=(2, 1000)))
    world.step(count=60)
    assert wheel.angular_velocity == pytest.approx(2, abs=1e-4)
    joint.change(plumb.Revolute(anchor_a=(0, 3), motor=(-1, 1000)))
    world.step(count=60)
    assert wheel.angular_velocity == pytest.approx(-1, abs=1e-4)
    assert joint.read()["angle"] == pytest.approx(wheel.angle, abs=1e-6)
    # A hinge that holds a disc at rest carries its weight.
    assert joint.read()["force"] == pytest.approx(wheel.mass * G, rel=1e-3)
    assert joint.bodies == (base, wheel)


def test_queries_events_and_hooks():
    world = plumb.World()
    floor = ground(world)
    box = world.create_body(plumb.ShapeDefinition(plumb.Box(1, 1), hit_events=True, pre_solve=True), position=(0, 3))
    assert world.ray_cast((0, 10), (0, -20))["body"] == box
    assert world.ray_cast((0, 10), (0, -20), ignore=box)["body"] == floor
    assert world.ray_cast((0, 10), (0, 5)) is None
    assert world.ray_casts([[0, 10, 0, -20], [0, 10, 0, 5]]) == pytest.approx([6.5 / 20, 1])
    assert [hit["body"] for hit in world.ray_cast_all((0, 10), (0, -20))] == [box, floor]
    assert world.shapes_at((0, 3)) == box.shapes
    assert world.overlap_box((-1, 2), (1, 4)) == box.shapes
    assert world.nearest((0, 5), 10)["distance"] == pytest.approx(1.5, abs=1e-6)
    hits, calls = [], []
    world.on_pre_solve(lambda contact: calls.append(contact["normal"]) or True)
    for _ in range(60):
        world.step()
        hits += world.events["hits"]
    assert len(hits) == 1 and hits[0]["speed"] == pytest.approx(math.sqrt(2 * G * 2.5), rel=0.02)
    assert calls and abs(calls[0][1]) == pytest.approx(1)
    world.on_pre_solve(lambda contact: 1 / 0)
    with pytest.raises(ZeroDivisionError):
        world.step()


def test_a_character_walks_on_the_ground():
    world = plumb.World()
    ground(world)
    position, velocity = (0, 0.02), (3, -1)
    for _ in range(30):
        moved = world.move(plumb.Capsule((0, 0.3), (0, 1), 0.3), position, velocity, 1 / 60)
        position, velocity = moved["position"], (3, -1)
        world.step()
    assert moved["on_ground"] and position[0] == pytest.approx(1.5, abs=1e-3)


@pytest.mark.parametrize("make", [plumb.Simulation.realtime, plumb.Simulation.precise])
def test_scenes_as_dicts(make):
    simulation = make(SCENE)
    simulation.step(60)
    assert simulation.names == ["ball"]
    assert simulation.state("ball")["position"][1] == pytest.approx(10 - G / 2, abs=1e-12)
    assert simulation.states.shape == (1, 6)
    saved = simulation.save()
    simulation.step(10)
    end = simulation.hash()
    simulation.restore(saved)
    simulation.step(10)
    assert simulation.hash() == end
    with pytest.raises(plumb.UnknownName):
        simulation.state("cube")


def test_a_precise_pendulum_has_the_tension_of_its_closed_form():
    scene = {"name": "pendulum", "bodies": [{"name": "bob", "position": [0, -1], "velocity": [2, 0], "mass": 1, "inertia": 1}],
             "joints": [{"type": "distance", "name": "rod", "body_a": "world", "body_b": "bob", "length": 1}]}
    simulation = plumb.Simulation.precise(scene, dt=1e-3)
    simulation.step()
    x, y, _, vx, vy, _ = simulation.states[0]
    force = simulation.forces()["joints"][0]["force"]
    # Along the rod: m v^2 / l + m g cos(angle).
    assert math.hypot(*force) == pytest.approx(vx**2 + vy**2 - G * y, rel=1e-9)


def test_a_batch_steps_each_world_with_its_own_actions():
    world = plumb.World(gravity=(0, 0))
    ball = world.create_body(plumb.Circle(0.5), mass=(2, 1, (0, 0)))
    batch = plumb.Batch(world, 8, [ball], threads=3)
    actions = np.zeros((8, 1, 3))
    actions[:, 0, 0] = np.arange(8)
    seen = batch.step(actions, dt=0.5, count=2)
    # x = F t^2 / (2 m) after 1 s, exact under a constant force but for float's rounding.
    assert seen[:, 0, 0] == pytest.approx(np.arange(8) / 4, rel=1e-6)
    assert seen[:, 0, 3] == pytest.approx(np.arange(8) / 2, rel=1e-6)
    hashes = batch.hashes()
    batch.reset([True] * 4 + [False] * 4)
    assert (batch.observe()[:4] == 0).all() and batch.hashes()[4:] == hashes[4:]
    batch.reset()
    assert (batch.step(actions, dt=0.5, count=2) == seen).all()
    with pytest.raises(plumb.InvalidValue, match="actions"):
        batch.step(actions[:3])


def cart_pole(**arguments):
    path = pathlib.Path(__file__).resolve().parents[3] / "bindings/python/examples/cart_pole.py"
    return runpy.run_path(str(path))["CartPole"](**arguments)


def test_a_pole_falls_unless_it_is_balanced():
    for gains, stands in ((np.zeros(4), False), (np.array([-1.0, -2.0, 30.0, 6.0]), True)):
        env = cart_pole(worlds=8, threads=2)
        seen, _ = env.reset(seed=1)
        fallen = np.zeros(8, bool)
        for _ in range(250):
            seen, _, terminated, _, _ = env.step(-seen @ gains)
            fallen |= terminated
        assert fallen.any() != stands and fallen.all() != stands


def test_an_environment_begins_episodes_anew_and_repeats_itself_on_any_threads():
    histories = []
    for threads in (1, 3):
        env, rows = cart_pole(worlds=6, threads=threads, limit=40), []
        first, _ = env.reset(seed=3)
        forces = np.linspace(-20, 20, 6)  # the hardest pushed fall, the others reach the limit
        for _ in range(130):
            rows.append(env.step(forces * (np.arange(6) % 2)))
        histories.append([first] + [np.concatenate(row[:1] + tuple(np.reshape(r, (6, 1)) for r in row[1:4]), axis=1) for row in rows])
    assert all((a == b).all() for a, b in zip(*histories))
    seen = np.array(histories[0][1:])
    rewards, terminated, truncated = seen[:, :, 4], seen[:, :, 5] > 0, seen[:, :, 6] > 0
    ended = terminated | truncated
    assert terminated.any() and truncated.any() and not (terminated & truncated).any()
    # The step after an end gives no reward, ends nothing, and shows a start.
    after = seen[1:][ended[:-1]]
    assert (after[:, 4:] == 0).all() and abs(after[:, :4]).max() < 0.05
    assert (rewards[1:][~ended[:-1] & ~terminated[1:]] == 1).all()


def test_worlds_step_on_threads():
    worlds = [plumb.World() for _ in range(4)]
    for world in worlds:
        ground(world), tower(world)
    threads = [threading.Thread(target=world.step, kwargs={"count": 100}) for world in worlds]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len({world.full_hash() for world in worlds}) == 1


def test_forces_as_an_array_and_bodies_as_keys():
    world = plumb.World(gravity=(0, 0))
    bodies = [world.create_body(plumb.Circle(0.5), position=(2 * i, 0), mass=(1, 1, (0, 0))) for i in range(3)]
    world.apply_forces([[0, 0, 0], [6, 0, 0], [0, 0, 6]])
    world.step(1 / 60)
    assert world.velocities[:, 0] == pytest.approx([0, 0.1, 0], rel=1e-6)
    assert bodies[2].angular_velocity == pytest.approx(0.1, rel=1e-6)
    assert {bodies[0]: "first"}[world.bodies[0]] == "first"
    with pytest.raises(plumb.InvalidValue, match="3 body indices"):
        world.apply_forces([[0, 0]])


def test_bodies_and_shapes_are_changed_after_they_were_made():
    world = plumb.World()
    body = world.create_body(plumb.Box(1, 1), position=(0, 3))
    body.name, body.user_data, body.shapes[0].density = "crate", 7, 4
    assert (body.name, body.user_data, body.mass) == ("crate", 7, 4)
    assert body.box == ((-0.5, 2.5), (0.5, 3.5))
    body.enabled = False
    world.step(count=10)
    assert body.position == (0, 3) and not body.enabled
    body.enabled = True
    world.step(count=10)
    assert body.position[1] < 3
    body.shapes[0].sensor = True
    assert body.shapes[0].sensor


def test_one_shape_is_asked_alone():
    world = plumb.World(precision="double")
    floor = world.create_body(type="static")
    chain = floor.create_chain([(10, 0), (0, 0), (-10, 0)])
    near = world.create_body(plumb.Circle(0.5), position=(0, 5)).shapes[0]
    far = world.create_body(plumb.Box(1, 1), position=(0, 2)).shapes[0]
    # From above the disc is in the way of the box; asked alone, the box is hit at 2.5 m.
    assert far.ray_cast((0, 10), (0, -10)) == {"point": (0, 2.5), "normal": (0, 1), "fraction": 0.75}
    assert near.ray_cast((2, 10), (0, -10)) is None
    assert near.contains((0, 5.4)) and not near.contains((0, 5.6)) and far.contains((0.4, 2.4))
    assert far.box == ((-0.5, 1.5), (0.5, 2.5))
    assert chain.segments[0].chain == chain and far.chain is None
    far.hit_events = far.pre_solve = True
    calls, hits = [], []
    world.on_pre_solve(lambda contact: calls.append(1) or True)
    for _ in range(60):
        world.step()
        hits += world.events["hits"]
    assert calls and hits


def test_games_set_their_own_rules():
    world = plumb.World(thresholds=(0.5, -1, -1))
    assert world.thresholds == (0.5, -1, -1)
    floor = ground(world)
    ghostly = 1 << 40
    crate = world.create_body(plumb.ShapeDefinition(plumb.Box(1, 1), hit_events=True), position=(0, 1.5))
    ghost = world.create_body(plumb.ShapeDefinition(plumb.Box(1, 1), category=ghostly), position=(3, 1.5))
    other = world.create_body(plumb.ShapeDefinition(plumb.Box(1, 1), mask=~ghostly & (2**64 - 1)), position=(6, 0.5))
    refused = set()

    def rule(a, b):
        refused.update({a.body, b.body} & {ghost})
        return ghost not in (a.body, b.body)

    world.on_filter(rule)
    lamp = world.create_body(plumb.Circle(0.5), position=(-9, 7))
    joint = world.create_joint(floor, lamp, plumb.Distance(1, anchor_a=(-9, 9)), report_force=5)
    hits, loads = [], []
    for _ in range(90):
        world.step()
        hits += world.events["hits"]
        loads += world.events["loaded"]
    assert refused == {ghost}
    assert ghost.position[1] < -3
    assert crate.position[1] == pytest.approx(0.5, abs=0.01) == other.position[1]
    assert hits[0]["impulse"] == pytest.approx(math.sqrt(2 * G), rel=0.1)
    assert loads[-1]["joint"] == joint
    # The lamp of 0.79 kg swings with what is left.
    assert loads[-1]["force"] == pytest.approx(math.pi / 4 * G, rel=0.05)
    assert crate.contacts()[0]["step_impulse"] == pytest.approx(G / 60, rel=1e-3)
    rows = world.contacts
    assert rows["step_impulse"].max() == pytest.approx(G / 60, rel=1e-3)
    with pytest.raises(plumb.Error, match="no spring"):
        joint.stiffness()
    joint.set_load_events()
    world.step()
    assert world.events["loaded"] == []
    world.thresholds = (1, 2, 3)
    assert world.thresholds == (1, 2, 3)
    crate.continuous = False
    assert not crate.continuous
    assert lamp.continuous


def test_threads_share_a_step_with_the_same_bits():
    hashes = set()
    for threads in (1, 2):
        world = plumb.World(threads=threads)
        ground(world)
        for i in range(400):
            world.create_body(plumb.Box(0.4, 0.4), position=(0.45 * (i % 20), 0.3 + 0.45 * (i // 20)))
        world.step(count=20)
        assert world.threads == threads
        hashes.add(world.full_hash())
    assert len(hashes) == 1
    with pytest.raises(plumb.InvalidValue, match="threads"):
        world.threads = 0


def test_a_world_goes_back_in_memory_and_takes_a_late_input():
    world = plumb.World()
    ground(world)
    player = world.create_body(plumb.Box(1, 1), position=(0, 3))
    rollback = plumb.Rollback(world, 8)
    assert (rollback.oldest, len(rollback)) == (-1, 0)
    for _ in range(20):
        rollback.save()
        world.step()
    assert (rollback.oldest, rollback.latest, len(rollback)) == (12, 19, 8)
    end, centres = world.full_hash(), world.centres
    rollback.back_to(14)
    world.step(count=6)
    assert world.full_hash() == end
    assert np.all(centres == world.centres)  # an old view stays valid memory
    rollback.back_to(14)
    player.apply_impulse((2, 0))
    world.step(count=6)
    assert player.position[0] == pytest.approx(0.2, rel=1e-5)
    assert not rollback.holds(3)
    with pytest.raises(plumb.InvalidValue, match="3"):
        rollback.back_to(3)
    with pytest.raises(plumb.InvalidValue, match="frames"):
        plumb.Rollback(world, 0)
    del world, player
    gc.collect()
    rollback.back_to(rollback.latest)  # it keeps its world


def test_the_stub_names_what_the_module_has():
    package = pathlib.Path(inspect.getfile(plumb)).parent
    stub = ast.parse((package / "__init__.pyi").read_text())
    assert (package / "py.typed").exists()
    declared = {}
    for node in stub.body:
        if isinstance(node, ast.ClassDef) and any(getattr(base, "id", "") == "TypedDict" for base in node.bases):
            declared[node.name] = set()  # its names are keys
        elif isinstance(node, ast.ClassDef):
            names = [n.name for n in node.body if isinstance(n, ast.FunctionDef)]
            names += [n.target.id for n in node.body if isinstance(n, ast.AnnAssign)]
            declared[node.name] = {name for name in names if not name.startswith("__")}
        elif isinstance(node, ast.FunctionDef):
            declared[node.name] = set()
    assert set(declared) | {"__version__"} == set(plumb.__all__)
    for name, members in declared.items():
        real = {member for member in dir(getattr(plumb, name)) if not member.startswith("_")}
        if inspect.isclass(getattr(plumb, name)) and not issubclass(getattr(plumb, name), Exception):
            own = {member for member in members}
            assert own <= real, (name, own - real)
            if own:
                assert real <= own, (name, real - own)
