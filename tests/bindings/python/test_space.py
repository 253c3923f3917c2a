"""pymunk's interface over plumb, against closed forms. Its own tests are run by run_pymunk_tests.py."""

import math

import pytest
from plumb import space as pm


def test_a_body_falls_as_it_must_and_lies_on_the_floor():
    space = pm.Space()
    space.gravity = 0, -9.81
    floor = pm.Segment(space.static_body, (-50, 0), (50, 0), 1)
    body = pm.Body(2, pm.moment_for_circle(2, 0, 0.5))
    body.position = 0, 10
    circle = pm.Circle(body, 0.5)
    floor.friction = circle.friction = 0.8
    space.add(floor, body, circle)
    for _ in range(60):
        space.step(1 / 60)
    assert body.position.y == pytest.approx(10 - 9.81 / 2, abs=1e-9)
    for _ in range(240):
        space.step(1 / 60)
    assert body.position.y == pytest.approx(1.5, abs=0.01)


def test_coefficients_are_multiplied():
    space = pm.Space()
    body = pm.Body(1, math.inf)
    body.position, body.velocity = (0, 3), (0, -4)
    ball, wall = pm.Circle(body, 1), pm.Segment(space.static_body, (-5, 0), (5, 0), 0.5)
    ball.elasticity, wall.elasticity = 0.8, 0.5
    space.add(body, ball, wall)
    for _ in range(60):
        space.step(1 / 60)
    assert body.velocity.y == pytest.approx(0.4 * 4, abs=1e-9)
    assert body.angle == 0


def test_a_spring_has_the_period_of_its_stiffness():
    space = pm.Space()
    body = pm.Body(2, 1)
    body.position = 3.5, 0
    space.add(body, pm.DampedSpring(space.static_body, body, (0, 0), (0, 0), 3, 2 * (2 * math.pi)**2, 0))
    # Springs are implicit: the amplitude of 0.5 m falls by (2 pi)^2 h / 2 a second, with substeps of h = 1/8000 s.
    for _ in range(2000):  # a period of 1 s
        space.step(1 / 2000)
    assert body.position.x == pytest.approx(3.5, abs=2e-3)
    for _ in range(1000):
        space.step(1 / 2000)
    assert body.position.x == pytest.approx(2.5, abs=3e-3)


def test_constraints_hold():
    space = pm.Space()
    space.gravity = 0, -9.81
    bodies = [pm.Body(1, 0.1) for _ in range(4)]
    for body, at in zip(bodies, ((2, 0), (10, 0), (20, 0), (30, 0))):
        body.position = at
    pin = pm.PinJoint(space.static_body, bodies[0])
    slide = pm.SlideJoint(space.static_body, bodies[1], (8, 0), (0, 0), 1, 3)
    pivot = pm.PivotJoint(space.static_body, bodies[2], (19, 0))
    groove = pm.GrooveJoint(space.static_body, bodies[3], (29, -4), (29, 4), (-1, 0))
    space.add(*bodies, pin, slide, pivot, groove)
    for _ in range(200):
        space.step(1 / 60)
        assert bodies[0].position.length == pytest.approx(2, abs=1e-3)
        assert 1 - 1e-3 < bodies[1].position.get_distance((8, 0)) < 3 + 1e-3
        assert bodies[2].local_to_world((-1, 0)).get_distance((19, 0)) < 1e-3
        assert bodies[3].local_to_world((-1, 0)).x == pytest.approx(29, abs=1e-2)  # a soft slide
    assert pin.impulse > 0
    with pytest.raises(NotImplementedError):
        space.add(pm.RotaryLimitJoint(space.static_body, bodies[0], 0, 1))


def test_collisions_are_told_once_and_changes_wait_for_the_end_of_the_step():
    space = pm.Space()
    bodies = [pm.Body(1, 1), pm.Body(1, 1)]
    bodies[0].position, bodies[0].velocity = (-3, 0), (5, 0)
    shapes = [pm.Circle(body, 0.5) for body in bodies]
    for shape in shapes:
        shape.collision_type, shape.elasticity = 3, 1
    space.add(*bodies, *shapes)
    told = []

    def begin(arbiter, _, data):
        told.append(("begin", arbiter.is_first_contact, data))
        assert arbiter.normal.x == pytest.approx(1 if arbiter.shapes[0] is shapes[0] else -1)

    def separate(arbiter, own, _):
        told.append(("separate", arbiter.is_removal))
        own.remove(shapes[1])
        assert shapes[1] in own.shapes

    space.on_collision(3, 3, begin=begin, separate=separate, data="mine")
    for _ in range(60):
        space.step(1 / 60)
    assert told == [("begin", True, "mine"), ("separate", False)]
    assert space.shapes == [shapes[0]]
    assert bodies[1].velocity.x == pytest.approx(5, abs=1e-6)


def test_queries_find_what_is_there():
    space = pm.Space()
    box = pm.Poly.create_box(space.static_body, (4, 2))
    ball = pm.Circle(space.static_body, 1, (5, 0))
    space.add(box, ball)
    every = pm.ShapeFilter()
    hit = space.segment_query_first((-5, 0.5), (10, 0.5), 0, every)
    assert hit.shape is box
    assert hit.point == pytest.approx((-2, 0.5))
    assert hit.alpha == pytest.approx(0.2)
    assert space.point_query_nearest((5, 3), 5, every).distance == pytest.approx(2)
    assert space.point_query_nearest((1.5, 0), 0, every).distance == pytest.approx(-0.5)
    assert space.bb_query(pm.BB(4, -1, 6, 1), every) == [ball]
    space.add(pm.Circle(space.static_body, 0.5, (0, 3)))
    group = pm.ShapeFilter(group=2)
    box.filter = group
    assert space.bb_query(pm.BB(-1, -1, 1, 1), group) == []
