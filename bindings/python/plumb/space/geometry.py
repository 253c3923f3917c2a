"""Distances, casts and overlaps of shapes: the queries that pymunk answers without a space."""

import math

from plumb.space.values import ContactPoint, ContactPointSet, PointQueryInfo, SegmentQueryInfo, Vec2d


def nearest(shape, p):
    """Returns the point of the surface nearest to p, its distance (negative inside) and the direction away from it."""
    points, r = shape._placed(), shape.radius
    inside = len(points) > 2
    best = None
    deepest, way = -math.inf, None
    for a, b in zip(points, points[1:] + points[:1]):
        along = b - a
        t = min(max((p - a).dot(along) / along.length_squared, 0), 1) if along.length_squared else 0
        at = a + along * t
        if best is None or (p - at).length < (p - best).length:
            best = at
        if inside:
            out = -along.perpendicular().normalized()
            height = (p - a).dot(out)
            inside = height <= 0
            if height > deepest:
                deepest, way = height, out
    if inside:
        return PointQueryInfo(shape, p + way * (r - deepest), deepest - r, way)
    gap = (p - best).length
    away = (p - best) / gap if gap else Vec2d(0, 1)
    return PointQueryInfo(shape, best + away * r, gap - r, away)


def cast(shape, start, end, radius):
    """Returns the hit of a disc of `radius` that moves from start to end: the first time at which it is that near."""
    length = (end - start).length
    travelled = 0.0
    for _ in range(64):  # conservative advancement: the distance is always safe to go
        near = nearest(shape, start + (end - start) * (travelled / length if length else 0))
        gap = near.distance - radius
        if gap <= 1e-9 * (1 + length):
            alpha = travelled / length if length else 0.0
            return SegmentQueryInfo(shape, near.point, near.gradient, alpha)
        travelled += gap
        if travelled > length:
            return None
    return SegmentQueryInfo(shape, near.point, near.gradient, travelled / length)


def touch(a, b):
    """Returns the contact of two shapes by the deepest of their corners in each other, or None if they are apart."""
    best = None
    for one, other, sign in ((a, b, -1), (b, a, 1)):
        for corner in one._placed():
            near = nearest(other, corner)
            gap = near.distance - one.radius
            if gap <= 0 and (best is None or gap < best[0]):
                edge = corner - near.gradient * one.radius
                pair = (edge, near.point) if one is a else (near.point, edge)
                best = gap, near.gradient * sign, pair
    if best is None:
        return None
    return ContactPointSet(best[1], [ContactPoint(best[2][0], best[2][1], best[0])])
