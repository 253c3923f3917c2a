"""Callbacks of plumb.space: what is asked before a contact acts, what is told, and what callbacks may change."""

import gc
import random
import weakref

import pytest
from plumb import space as pm

STEP = 1 / 60


def thrown_at_a_platform(seed, shape, phase):
    """Returns the greatest height of a body thrown up through a one-way platform at 2 m, and that of free flight."""
    chance = random.Random(seed)
    space = pm.Space()
    space.gravity = 0, -10
    speed, start = chance.uniform(7, 30), chance.uniform(0, 1)
    platform = pm.Segment(space.static_body, (-50, 2), (50, 2), chance.uniform(0, 0.1))
    body = pm.Body(1, 1)
    body.position, body.velocity = (0, start), (0, speed)
    own = pm.Circle(body, 0.3) if shape == "circle" else pm.Poly.create_box(body, (0.6, 0.6))
    platform.elasticity = own.elasticity = chance.choice([0, 1])
    space.add(platform, body, own)
    normals = []

    def one_way(arbiter, *_):
        normals.append(arbiter.normal.y * (1 if arbiter.shapes[0] is own else -1))
        assert len(arbiter.contact_point_set.points) > 0
        if body.velocity.y > 0:
            arbiter.process_collision = False

    space.on_collision(0, 0, **{name: one_way for name in phase.split()})
    top = 0
    for _ in range(240):
        space.step(STEP)
        top = max(top, body.position.y)
    assert all(abs(normal) > 0.99 for normal in normals)
    return top, start + speed**2 / 20


@pytest.mark.parametrize("phase", ["begin", "pre_solve", "begin pre_solve"])
@pytest.mark.parametrize("shape", ["circle", "box"])
def test_one_way_platforms_let_through_from_below(shape, phase):
    for seed in range(30):
        top, free = thrown_at_a_platform(seed, shape, phase)
        # Seen at steps: half of one after the top it is lower by g dt^2 / 8.
        assert top == pytest.approx(free, abs=10 * STEP**2 / 8 + 1e-9) or free < 2.7


def test_what_the_last_callback_left_holds_until_the_shapes_part():
    space = pm.Space()
    floor, body = pm.Segment(space.static_body, (-50, 0), (50, 0), 0), pm.Body(1, 1)
    body.position, body.velocity = (0, 2), (0, -5)
    space.add(floor, body, pm.Circle(body, 0.5))
    told = []

    def refuse(arbiter, *_):
        told.append(("begin", arbiter.process_collision))
        arbiter.process_collision = False

    space.on_collision(0, 0, begin=refuse, pre_solve=lambda a, *_: told.append(("pre_solve", a.process_collision)),
                       post_solve=lambda *_: told.append("post_solve"), separate=lambda *_: told.append("separate"))
    for _ in range(60):
        space.step(STEP)
    assert body.velocity.y == pytest.approx(-5)
    assert told[0] == ("begin", True) and told[-1] == "separate"
    assert told.count("separate") == 1 and "post_solve" not in told
    assert set(told[1:-1]) == {("pre_solve", False)} and len(told) > 10  # 0.2 s in the floor


@pytest.mark.parametrize("speed", [2, 10, 300])
def test_callbacks_see_the_impact_before_it_acts_and_its_impulse_afterwards(speed):
    space = pm.Space()
    floor, body = pm.Segment(space.static_body, (-50, 0), (50, 0), 0), pm.Body(2, 1)
    body.position, body.velocity = (0, 3.1), (0, -speed)
    circle = pm.Circle(body, 0.5)
    circle.elasticity, floor.elasticity, circle.collision_type = 0.5, 1, 1
    space.add(floor, body, circle)
    seen, impulses = [], []
    space.on_collision(1, None, begin=lambda a, *_: seen.append((body.velocity.y, a.normal.y)),
                       post_solve=lambda a, *_: impulses.append(a.total_impulse.y))
    for _ in range(int(4 / speed / STEP) + 20):
        space.step(STEP)
    assert seen == [(pytest.approx(-speed), pytest.approx(-1))]
    # On the first shape, as in Chipmunk.
    assert impulses == [pytest.approx(2 * 1.5 * speed)]
    assert body.velocity.y == pytest.approx(speed / 2)


def test_shapes_that_pass_by_do_not_touch():
    space = pm.Space()
    floor, body = pm.Segment(space.static_body, (-50, 0), (50, 0), 0), pm.Body(1, 1)
    body.position, body.velocity = (-3, 0.501), (3, 0)
    space.add(floor, body, pm.Circle(body, 0.5))
    told = []
    tell = lambda *_: told.append(1)
    space.on_collision(0, 0, begin=tell, pre_solve=tell, post_solve=tell, separate=tell)
    for _ in range(120):
        space.step(STEP)
    assert told == []


def test_sensors_tell_of_their_visitors():
    space = pm.Space()
    gate, body = pm.Segment(space.static_body, (0, -5), (0, 5), 0.2), pm.Body(1, 1)
    body.position, body.velocity = (-1, 0), (3, 0)
    gate.sensor, gate.collision_type = True, 7
    space.add(gate, body, pm.Circle(body, 0.1))
    told = []
    space.on_collision(7, 0, begin=lambda a, *_: told.append(("begin", round(a.normal.x))),
                       pre_solve=lambda *_: told.append("pre_solve"), post_solve=lambda *_: told.append("post_solve"),
                       separate=lambda *_: told.append("separate"))
    for _ in range(60):
        space.step(STEP)
    assert told[0] == ("begin", -1) and told[-1] == "separate"
    assert len(told) > 8 and set(told[1:-1]) == {"pre_solve"}
    assert body.velocity == (3, 0)


CHANGES = {
    "velocity": (lambda s, b, c: setattr(b, "velocity", (0, 7)), lambda s, b, c: b.velocity.y > 0),
    "angular velocity": (lambda s, b, c: setattr(b, "angular_velocity", 7), lambda s, b, c: b.angular_velocity == 7),
    "impulse": (lambda s, b, c: b.apply_impulse_at_local_point((0, 14)), lambda s, b, c: b.velocity.y > 0),
    "force": (lambda s, b, c: b.apply_force_at_local_point((0, 5000)), lambda s, b, c: b.velocity.y > 0),
    "position": (lambda s, b, c: setattr(b, "position", (0, 50)), lambda s, b, c: b.position.y > 40),
    "friction": (lambda s, b, c: setattr(c, "friction", 0.25), lambda s, b, c: c._held.friction == 0.25),
    "elasticity": (lambda s, b, c: setattr(c, "elasticity", 0.5), lambda s, b, c: c._held.restitution == 0.5),
    "filter": (lambda s, b, c: setattr(c, "filter", pm.ShapeFilter(mask=0)), lambda s, b, c: b.position.y < 0.4),
    "sensor": (lambda s, b, c: setattr(c, "sensor", True), lambda s, b, c: b.position.y < 0.4),
    "radius": (lambda s, b, c: c.unsafe_set_radius(0.25), lambda s, b, c: b.position.y < 0.4),
    "gravity": (lambda s, b, c: setattr(s, "gravity", (0, 90)), lambda s, b, c: b.velocity.y > 0),
    "damping": (lambda s, b, c: setattr(s, "damping", 0.5), lambda s, b, c: b._held.linear_damping > 0),
    "mass": (lambda s, b, c: setattr(b, "mass", 5), lambda s, b, c: b._held.mass == 5),
    "type": (lambda s, b, c: setattr(b, "body_type", pm.Body.KINEMATIC), lambda s, b, c: b._held.type == "kinematic"),
    "removal": (lambda s, b, c: s.remove(b, c), lambda s, b, c: s.bodies == []),
}


@pytest.mark.parametrize("change", CHANGES)
@pytest.mark.parametrize("phase", ["begin", "pre_solve", "post_solve"])
@pytest.mark.parametrize("speed", [3, 60])  # near, and in flight
def test_callbacks_may_change_bodies_and_shapes_which_holds_from_the_next_step(change, phase, speed):
    act, holds = CHANGES[change]
    space = pm.Space()
    space.gravity = 0, -10
    floor, body = pm.Segment(space.static_body, (-50, 0), (50, 0), 0), pm.Body(2, 1)
    body.position, body.velocity = (0, 1.7), (0, -speed)
    circle = pm.Circle(body, 0.5)
    space.add(floor, body, circle)
    done = []

    def once(*_):
        if not done:
            done.append(1)
            act(space, body, circle)

    space.on_collision(0, 0, **{phase: once})
    for _ in range(60):
        space.step(STEP)
        if done:
            break
    assert done
    for _ in range(20):
        space.step(STEP)
    assert holds(space, body, circle)


def test_a_contacts_own_coefficients_cannot_be_set():
    space = pm.Space()
    space.gravity = 0, -10
    floor, body = pm.Segment(space.static_body, (-50, 0), (50, 0), 0), pm.Body(2, 1)
    body.position = 0, 0.5
    space.add(floor, body, pm.Circle(body, 0.5))
    for name in ("friction", "restitution", "surface_velocity"):
        space.on_collision(0, 0, pre_solve=lambda a, *_: setattr(a, name, getattr(a, name)))
        with pytest.raises(NotImplementedError):
            space.step(STEP)


def test_handlers_keep_what_is_not_given_again():
    space = pm.Space()
    bodies = [pm.Body(1, 1), pm.Body(1, 1)]
    bodies[1].position = 0.5, 0
    space.add(*bodies, *(pm.Circle(body, 0.5) for body in bodies))
    told = []
    space.on_collision(0, 0, begin=lambda a, s, data: told.append(data), data="first")
    space.on_collision(0, 0, pre_solve=lambda a, s, data: told.append(data), data="second")
    space.step(STEP)
    assert told == ["first", "second"]
    space.on_collision(0, 0, pre_solve=pm.empty_callback)
    space.step(STEP)
    assert told == ["first", "second"]


def test_a_shape_that_changes_while_it_touches_begins_once_and_is_told_when_it_parts():
    space = pm.Space()
    space.gravity = 0, -10
    floor, body = pm.Segment(space.static_body, (-50, 0), (50, 0), 0), pm.Body(1, 1)
    body.position = 0, 0.5
    circle = pm.Circle(body, 0.5)
    space.add(floor, body, circle)
    told = []
    space.on_collision(0, 0, begin=lambda *_: told.append("begin"), separate=lambda *_: told.append("separate"))
    for change in (lambda: setattr(circle, "friction", 0.5), lambda: setattr(circle, "elasticity", 0.5),
                   lambda: circle.unsafe_set_radius(0.51), lambda: setattr(circle, "collision_type", 0)):
        for _ in range(5):
            space.step(STEP)
        change()
    for _ in range(5):
        space.step(STEP)
    assert told == ["begin"]
    circle.unsafe_set_radius(0.1)  # above the floor now
    space.gravity = 0, 0
    body.velocity = 0, 0
    for _ in range(2):
        space.step(STEP)
    assert told == ["begin", "separate"]


def test_the_product_of_elasticities_may_be_above_1():
    for one, other in ((0.5, 0.8), (1.2, 0.8), (1, 1.5), (1.5, 0.95)):
        space = pm.Space()
        bumper, body = pm.Segment(space.static_body, (-50, 0), (50, 0), 0), pm.Body(2, 1)
        body.position, body.velocity = (0, 2), (0, -5)
        circle = pm.Circle(body, 0.5)
        bumper.elasticity, circle.elasticity = one, other
        space.add(bumper, body, circle)
        for _ in range(40):
            space.step(STEP)
        assert body.velocity.y == pytest.approx(5 * one * other, rel=1e-6)


@pytest.mark.parametrize("belt, place, gravity, moved", [
    (((-50, 0), (50, 0)), (0, 0.5), (0, -10), (2, 0)), (((50, 0), (-50, 0)), (0, 0.5), (0, -10), (2, 0)),
    (((-50, 0), (50, 0)), (0, -0.5), (0, 10), (2, 0)), (((0, -50), (0, 50)), (0.5, 0), (-10, 0), (0, 2)),
    (((0, -50), (0, 50)), (-0.5, 0), (10, 0), (0, 2))])
@pytest.mark.parametrize("who", ["belt", "box"])
def test_surfaces_move_in_the_direction_of_their_velocity(belt, place, gravity, moved, who):
    space = pm.Space()
    space.gravity = gravity
    ground, body = pm.Segment(space.static_body, *belt, 0), pm.Body(1, float("inf"))
    body.position = place
    box = pm.Poly.create_box(body, (1, 1))
    ground.friction = box.friction = 1
    (ground if who == "belt" else box).surface_velocity = moved
    space.add(ground, body, box)
    for _ in range(120):
        space.step(STEP)
    sign = 1 if who == "belt" else -1  # what walks is pushed by its feet
    assert body.velocity == pytest.approx((sign * moved[0], sign * moved[1]), abs=1e-6)
    (ground if who == "belt" else box).surface_velocity = 0, 0
    for _ in range(120):
        space.step(STEP)
    assert body.velocity == pytest.approx((0, 0), abs=1e-6)


def test_dropped_spaces_are_freed():
    gone = []
    for _ in range(20):
        space = pm.Space()
        body = pm.Body(1, 1)
        space.add(body, pm.Circle(body, 1), pm.PivotJoint(space.static_body, body, (0, 0)))
        space.on_collision(0, 0, begin=lambda *_: None)
        space.step(STEP)
        gone.append(weakref.ref(space))
        del space
    gc.collect()
    assert [each() for each in gone] == [None] * 20
    assert body.space is None
    body.velocity = 1, 0  # a body outlives its space
    other = pm.Space()
    other.add(body)
    other.step(STEP)
    assert body.position.x == pytest.approx(STEP)


def test_settings_act_or_are_refused():
    def stretch(iterations):
        space = pm.Space()
        space.gravity, space.iterations = (0, -100), iterations
        last, worst = space.static_body, 0
        bodies = []
        for i in range(12):
            body = pm.Body(1 if i < 11 else 100, 1)
            body.position = i + 1, 0
            space.add(body, pm.PinJoint(last, body))
            bodies.append(body)
            last = body
        for _ in range(120):
            space.step(STEP)
            ends = [space.static_body] + bodies
            worst = max(worst, *(abs((q.position - p.position).length - 1) for p, q in zip(ends, bodies)))
        return worst

    assert stretch(40) < 0.5 * stretch(10)

    def sleeps_after(seconds, speed=0.0, idle=0.0):
        space = pm.Space()
        space.sleep_time_threshold, space.idle_speed_threshold = seconds, idle
        body = pm.Body(1, 1)
        body.velocity = speed, 0
        space.add(body, pm.Circle(body, 0.5))
        for step in range(1, 300):
            space.step(STEP)
            if body.is_sleeping:
                return step * STEP
        return None

    assert sleeps_after(0.5) == pytest.approx(0.5, abs=0.1)
    assert sleeps_after(2) == pytest.approx(2, abs=0.1)
    assert sleeps_after(float("inf")) is None
    space = pm.Space()
    space.collision_slop = space.collision_slop
    for name in ("collision_slop", "collision_bias", "collision_persistence"):
        with pytest.raises(NotImplementedError):
            setattr(space, name, 0.5)
