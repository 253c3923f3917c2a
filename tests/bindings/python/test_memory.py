"""The Python module: worlds that nothing refers to are freed, also where their hooks refer to them; Ctrl-C stops steps."""

import gc
import signal
import subprocess
import sys
import threading
import time
import weakref

import plumb
import pytest


class Game:
    """A world whose hooks refer to the game, which refers to the world and its objects."""

    def __init__(self, makes_hooks=True):
        self.world = plumb.World()
        self.ground = self.world.create_body(plumb.Box(20, 2), type="static", position=(0, -1))
        self.ball = self.world.create_body(plumb.ShapeDefinition(plumb.Circle(0.5), pre_solve=True), position=(0, 0.4))
        self.shape, self.views = self.ball.shapes[0], self.world.centres
        self.rollback = plumb.Rollback(self.world, 3)
        self.calls = 0
        if makes_hooks:
            self.world.on_pre_solve(self.on_contact)
            self.world.on_filter(self.collides)

    def on_contact(self, contact):
        self.calls += 1
        return contact["shape_a"].valid

    def collides(self, a, b):
        self.calls += 1
        return a.body.valid and b.body.valid


@pytest.fixture
def no_automatic_collection():
    gc.collect()
    gc.disable()
    yield
    gc.enable()


def test_worlds_are_freed_though_their_hooks_refer_to_them(no_automatic_collection):
    gone = []
    for _ in range(20):
        game = Game()
        game.world.step()
        assert game.calls > 0
        gone.append(weakref.ref(game))
    del game
    gc.collect()
    assert [each() for each in gone] == [None] * 20


def test_memory_does_not_grow_with_games():
    program = """
import gc, resource
import plumb
class Game:
    def __init__(self):
        self.world = plumb.World()
        self.bodies = [self.world.create_body(plumb.Circle(0.5), position=(1.5 * i, 0)) for i in range(300)]
        self.world.on_filter(lambda a, b: self.world.time >= 0)
        self.world.step()
def run(count):
    for _ in range(count): Game()
    gc.collect()
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
start = run(30)
print(run(120) - start)
"""
    run = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert int(run.stdout) < 5000  # kB; 120 worlds have about 60 MB


def test_hooks_live_as_long_as_any_handle_of_their_world(no_automatic_collection):
    game = Game()
    body, calls = game.ball, []
    game.world.on_pre_solve(lambda contact: calls.append(contact) is None)
    world = game.world
    del game
    gc.collect()
    world.step()
    assert len(calls) > 0
    del world, calls
    gc.collect()
    assert body.position[1] < 1  # the body keeps its world
    batch = plumb.Batch(plumb.World(), 2, [])
    seen = []
    batch.world(1).create_body(plumb.Circle(1))
    batch.world(1).create_body(plumb.Circle(1))
    batch.world(1).on_filter(lambda a, b: seen.append(a) is None)
    gc.collect()
    batch.step()
    assert len(seen) == 1


def test_a_batch_is_freed_though_hooks_of_its_worlds_refer_to_it(no_automatic_collection):
    class Learner:
        def __init__(self):
            self.batch = plumb.Batch(plumb.World(), 2, [])
            for i in range(2):
                self.batch.world(i).on_filter(lambda a, b: len(self.batch) == 2)

    gone = weakref.ref(Learner())
    gc.collect()
    assert gone() is None


def test_views_outlive_their_world(no_automatic_collection):
    world = plumb.World(gravity=(0, 0))
    world.create_body(plumb.Circle(1), position=(3, 4))
    centres, velocities = world.centres, world.velocities
    gone = weakref.ref(world)
    del world
    assert gone() is None
    more = [plumb.World().create_body(plumb.Circle(1)) for _ in range(50)]
    assert centres.tolist() == [[3, 4]] and velocities.tolist() == [[0, 0]] and more


def test_copies_of_a_world_do_not_lose_hooks_without_a_word():
    world = plumb.World()
    for hook in (world.on_filter, world.on_pre_solve):
        hook(lambda *_: True)
        with pytest.raises(plumb.Unsupported, match="hook"):
            plumb.Batch(world, 2, [])
        hook(None)
    assert len(plumb.Batch(world, 2, [])) == 2


@pytest.mark.parametrize("steps", ["world.step(count=10**9)", "plumb.Batch(world, 2, [], threads=2).step(count=10**9)",
                                   "simulation.step(10**9)"])
def test_an_interrupt_stops_many_steps(steps):
    program = f"""
import plumb
world = plumb.World()
world.create_body(plumb.Circle(1))
simulation = plumb.Simulation.realtime({{"bodies": [{{"mass": 1, "inertia": 1, "name": "a"}}]}})
print("ready", flush=True)
try:
    {steps}
except KeyboardInterrupt:
    print(world.step_count < 10**9)
"""
    with subprocess.Popen([sys.executable, "-c", program], stdout=subprocess.PIPE, text=True) as run:
        timer = threading.Timer(20, run.kill)
        timer.start()
        assert run.stdout.readline() == "ready\n"
        time.sleep(0.2)
        run.send_signal(signal.SIGINT)
        assert run.stdout.readline() == "True\n"
        timer.cancel()


CLASSES = [each for each in vars(plumb).values() if isinstance(each, type) and each.__module__ == "plumb._plumb"]


@pytest.mark.parametrize("made", CLASSES, ids=lambda each: each.__name__)
def test_objects_that_were_not_initialised_refuse_every_call(made):
    program = f"""
import plumb
made = plumb.{made.__name__}
try:
    each = made.__new__(made)
except TypeError:
    print("refused")
    raise SystemExit
for name in dir(made):
    if name.startswith("__"): continue
    try:
        value = getattr(each, name)
        if not callable(value): raise SystemExit(name)
    except TypeError: pass
for call in (lambda: each.step(), lambda: each.save(), lambda: plumb.World().create_body(each),
             lambda: plumb.Rollback(each, 2), lambda: plumb.Batch(each, 2, []),
             lambda: plumb.World().create_joint(plumb.World().create_body(), plumb.World().create_body(), each)):
    try: call()
    except (TypeError, AttributeError): pass
    else: raise SystemExit("accepted")
import gc; gc.collect(); del each; gc.collect()
print("refused")
"""
    run = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert (run.returncode, run.stdout) == (0, "refused\n"), run.stderr
