"""Queries and geometry of plumb.space, against closed forms and brute force."""

import math
import random

import numpy as np
import pytest
from plumb import space as pm

EVERY = pm.ShapeFilter()


def some_space(seed, count=40):
    chance = random.Random(seed)
    space = pm.Space()
    for _ in range(count):
        body = pm.Body(1, 1, chance.choice([pm.Body.DYNAMIC, pm.Body.KINEMATIC, pm.Body.STATIC]))
        body.position, body.angle = (chance.uniform(-9, 9), chance.uniform(-9, 9)), chance.uniform(-3, 3)
        kind = chance.randrange(3)
        point = lambda: (chance.uniform(-1, 1), chance.uniform(-1, 1))
        if kind == 0:
            shape = pm.Circle(body, chance.uniform(0.1, 1), point())
        elif kind == 1:
            shape = pm.Segment(body, point(), point(), chance.choice([0, 0.3]))
        else:
            shape = pm.Poly(body, [(-0.5, -0.2), (0.6, -0.4), (0.4, 0.7), (-0.3, 0.5)], None, chance.choice([0, 0.2]))
        shape.sensor = chance.random() < 0.2
        shape.filter = pm.ShapeFilter(group=chance.choice([0, 0, 1]), categories=chance.choice([1, 2, 0xFFFFFFFF]))
        space.add(body, shape)
    return space, chance


@pytest.mark.parametrize("seed", range(20))
def test_the_tree_finds_what_a_look_at_every_shape_finds(seed):
    space, chance = some_space(seed)
    for _ in range(20):
        p, q = ((chance.uniform(-9, 9), chance.uniform(-9, 9)) for _ in range(2))
        reach, radius = chance.choice([0, chance.uniform(0, 3), math.inf]), chance.choice([0, chance.uniform(0, 1)])
        seen = chance.choice([EVERY, pm.ShapeFilter(group=1), pm.ShapeFilter(mask=2), pm.ShapeFilter(categories=1)])
        shapes = [s for s in space.shapes if not s.filter.rejects(seen)]
        near = [s.point_query(p) for s in shapes]
        near = [hit for hit in near if hit.distance <= reach]
        assert space.point_query(p, reach, seen) == near
        assert space.point_query_nearest(p, reach, seen) == min(near, key=lambda hit: hit.distance, default=None)
        hits = [hit for hit in (s.segment_query(p, q, radius) for s in shapes) if hit is not None]
        assert space.segment_query(p, q, radius, seen) == hits
        assert space.segment_query_first(p, q, radius, seen) == min(hits, key=lambda hit: hit.alpha, default=None)


def test_queries_follow_a_body_that_was_moved():
    space = pm.Space()
    body = pm.Body(1, 1)
    circle = pm.Circle(body, 1)
    space.add(body, circle)
    body.position = 30, 0
    assert space.bb_query(pm.BB(29, -1, 31, 1), EVERY) == [circle]
    assert space.point_query((0, 0), 5, EVERY) == []
    assert space.segment_query_first((25, 0), (35, 0), 0, EVERY).alpha == pytest.approx(0.4)


@pytest.mark.parametrize("size", [1e-3, 1, 100])
def test_a_segment_hits_a_disc_where_the_quadratic_equation_says(size):
    for seed in range(1500):
        chance = random.Random(seed)
        centre = pm.Vec2d(chance.uniform(-2, 2), chance.uniform(-2, 2)) * size
        radius = chance.uniform(0.1, 1) * size
        p, q = (pm.Vec2d(chance.uniform(-6, 6), chance.uniform(-6, 6)) * size for _ in range(2))
        body = pm.Body(1, 1)
        body.position = centre
        hit = pm.Circle(body, radius).segment_query(p, q)
        if (p - centre).length < radius:
            continue
        way = q - p
        half, rest = way.dot(p - centre), (p - centre).length_squared - radius**2
        inside = half * half - way.length_squared * rest
        alpha = (-half - math.sqrt(inside)) / way.length_squared if inside >= 0 else -1
        if 0 <= alpha <= 1:
            assert hit is not None and hit.alpha == pytest.approx(alpha, abs=1e-9)
            assert hit.point == pytest.approx(p + way * alpha, abs=1e-9 * size)
        else:
            assert hit is None


def least_translation(a, b):
    """Returns the least translation that parts two outlines, by 20,000 directions."""
    angles = np.linspace(0, math.tau, 20000, endpoint=False)
    ways = np.array([np.cos(angles), np.sin(angles)])
    return ((np.array(a) @ ways).max(axis=0) - (np.array(b) @ ways).min(axis=0)).min()


def test_overlap_is_the_least_translation_that_parts_two_shapes():
    overlapping = 0
    for seed in range(60):
        chance = random.Random(seed)
        body = pm.Body(1, 1)
        outline = lambda count: [(chance.uniform(-1, 1), chance.uniform(-1, 1)) for _ in range(count)]
        a, b = pm.Poly(body, outline(chance.randint(4, 7))), None
        b = (pm.Segment(body, *outline(2), 0) if seed % 2 else pm.Poly(body, outline(chance.randint(4, 7))))
        depth = least_translation(a._corners(), b._corners())
        points = a.shapes_collide(b).points
        assert (len(points) > 0) == (depth > 0)
        if points:
            overlapping += 1
            assert -points[0].distance == pytest.approx(depth, abs=2e-3)
            normal = a.shapes_collide(b).normal
            for point in points:
                assert (point.point_b - point.point_a).dot(normal) == pytest.approx(point.distance, abs=1e-9)
            assert b.shapes_collide(a).points[0].distance == pytest.approx(points[0].distance, abs=1e-9)
    assert overlapping > 20


def test_rounded_shapes_touch_by_their_radii():
    body = pm.Body(1, 1)
    disc = lambda x, y, r: pm.Circle(body, r, (x, y))
    assert disc(0, 0, 1).shapes_collide(disc(1.5, 0, 1)).points[0].distance == pytest.approx(-0.5)
    assert disc(0, 0, 1).shapes_collide(disc(0, 2.1, 1)).points == []
    assert disc(0, 0, 1).shapes_collide(disc(-2.1, 0, 1)).points == []
    bar = pm.Segment(body, (-2, 0), (2, 0), 0.5)
    hit = disc(1, 1.2, 1).shapes_collide(bar)
    assert hit.normal == pytest.approx((0, -1)) and hit.points[0].distance == pytest.approx(-0.3)
    box = pm.Poly.create_box(body, (2, 2))
    assert disc(0.2, 0.9, 0.5).shapes_collide(box).points[0].distance == pytest.approx(-0.6)
    lying = pm.Poly(body, [(0.5, 0.9), (3, 0.9), (3, 2), (0.5, 2)])
    points = box.shapes_collide(lying)
    assert points.normal == pytest.approx((0, 1))
    assert sorted(point.point_a.x for point in points.points) == pytest.approx([0.5, 1])


def test_a_query_does_not_look_at_every_shape(monkeypatch):
    space, _ = some_space(1, count=400)
    from plumb.space import queries
    looked = []
    for name in ("cast", "nearest"):
        real = getattr(queries, name)
        monkeypatch.setattr(queries, name, lambda shape, *rest, real=real: looked.append(shape) or real(shape, *rest))
    body = pm.Body(body_type=pm.Body.STATIC)
    body.position = 100, 0
    space.add(body, pm.Circle(body, 1))
    assert space.segment_query_first((90, 0), (110, 0), 0.1, EVERY).alpha == pytest.approx(8.9 / 20)
    assert space.point_query_nearest((100, 3), 5, EVERY).distance == pytest.approx(2)
    assert len(looked) == 2
