"""The Python module: force laws act as their formulas say."""

import math

import numpy as np
import plumb
import pytest

G = 9.81


def test_force_laws_act_as_their_formulas_say():
    def end(law, count=60, gravity=(0, 0), **given):
        world = plumb.World(precision="double", gravity=gravity)
        body = world.create_body(mass=(2, 1, (0, 0)), velocity=(2, 0), **given)
        for _ in range(count):
            law(world, body)
            world.step()
        return body

    assert end(lambda w, b: w.apply_linear_drag(3)).velocity[0] == pytest.approx(2 * math.exp(-1.5), rel=1e-12)
    # v = v0 / (1 + c v0 t / m); the law is of second order in the step.
    assert end(lambda w, b: w.apply_quadratic_drag(0.5)).velocity[0] == pytest.approx(2 / 1.5, rel=1e-4)
    lifted = end(lambda w, b: w.apply_law(lambda body: (0, G * body.mass, 0.5)), gravity=(0, -G))
    assert lifted.velocity == pytest.approx((2, 0), abs=1e-12)
    assert lifted.angular_velocity == pytest.approx(0.5, rel=1e-12)
    rows = end(lambda w, b: w.apply_wrenches([[4, 0, 1]]))
    assert (rows.velocity[0], rows.angular_velocity) == pytest.approx((4, 1), rel=1e-12)
    # Half a period of sqrt(strength).
    swung = end(lambda w, b: w.apply_attraction((0, 0), math.pi**2, falloff="linear"))
    assert swung.velocity[0] == pytest.approx(-2, rel=5e-3)
    assert end(lambda w, b: w.apply_wind((9, 0)), shapes=plumb.Box(1, 1)).velocity[0] > 2

    world = plumb.World(gravity=(0, 0))
    a, b = (world.create_body(plumb.Circle(0.5), position=(x, 0)) for x in (0, 5))
    world.apply_spring(a, (0, 0), b, (0, 0), stiffness=1, rest_length=1)
    world.apply_attraction(a, 10)
    world.step()
    assert a.velocity[0] > 0 and a.velocity[0] + b.velocity[0] == pytest.approx(0, abs=1e-6)
    world.explode((2.5, 0), impulse=1)
    assert a.velocity[0] < 0 < b.velocity[0]


def test_a_law_of_ones_own_sees_the_middle_of_the_step():
    world = plumb.World(precision="double", gravity=(0, 0))
    body = world.create_body(mass=(2, 1, (0, 0)), position=(3, 0), user_data=7)
    seen = []

    def spring(state):
        seen.append((state.body, state.user_data, state.inertia, state.angle, state.angular_velocity))
        return -8 * state.centre[0], -8 * state.centre[1], 0

    for _ in range(300):
        world.apply_law(spring)
        world.step()
    # x_i = 3 cos(i a) solves x_(i+1) - 2 x_i + x_(i-1) = -(w dt)^2 x_i, the force at the middle of each step.
    a = math.acos(1 - 0.5 * 4 / 60**2)
    assert body.position == pytest.approx((3 * math.cos(300 * a), 0), abs=1e-11)
    assert seen[0] == (body, 7, 1, 0, 0)
    centres = []
    body.velocity = (1, 0)
    for dt in (0, 1 / 30):
        world.apply_law(lambda state: (centres.append(state.centre[0]), 0, 0)[1:] + (0,), dt=dt)
    assert centres == pytest.approx([body.position[0], body.position[0] + 1 / 60], rel=1e-12)
    with pytest.raises(plumb.InvalidValue, match="-1"):
        world.apply_law(spring, dt=-1)


def test_a_raft_floats_with_half_of_it_under_water():
    world = plumb.World()
    world.create_body(plumb.Box(40, 2), type="static", position=(0, -1))
    raft = world.create_body(plumb.Box(1, 1), position=(0, 3))
    for _ in range(900):
        world.apply_water(3, density=2, linear_drag=5, angular_drag=5, wakes=True)
        world.step()
    assert raft.position[1] == pytest.approx(3, abs=1e-3)


def test_a_law_that_fails_leaves_the_world_as_it_was():
    world, other = plumb.World(), plumb.World()
    body = world.create_body(plumb.Circle(0.5))
    before = world.full_hash()
    with pytest.raises(ZeroDivisionError):
        world.apply_law(lambda body: (1 / 0, 0, 0))
    with pytest.raises(plumb.InvalidValue, match="shape"):
        world.apply_wrenches(np.zeros((2, 3)))
    with pytest.raises(plumb.InvalidValue, match="-1"):
        world.apply_linear_drag(-1)
    with pytest.raises(plumb.UnknownName, match="inverse_square"):
        world.apply_attraction((0, 0), 1, falloff="cubic")
    with pytest.raises(plumb.InvalidValue, match="another world"):
        world.apply_attraction(other.create_body(plumb.Circle(0.5)), 1)
    assert world.full_hash() == before
    world.apply_law(lambda body: (math.nan, 0, 0))
    assert body.quarantined
