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
    """Returns the first hit of a disc of `radius` that moves from start to end, or None.

    The disc's centre meets the shape grown by the radius: its corners are discs, its edges lines shifted outwards.
    """
    points, r = shape._placed(), shape.radius + radius
    near = nearest(shape, start)
    if near.distance <= radius:
        return SegmentQueryInfo(shape, near.point, near.gradient, 0.0)
    way = end - start
    length = way.length
    if length == 0:
        return None
    along = way / length
    first, normal = math.inf, None
    if r > 0:
        for corner in points:
            offset = corner - start
            middle, aside = offset.dot(along), offset.cross(along)
            if abs(aside) <= r:
                entry = middle - math.sqrt((r - aside) * (r + aside))
                if 0 <= entry < first:
                    first, normal = entry, (start + along * entry - corner) / r
    edges = list(zip(points, points[1:] + points[:1])) if len(points) > 1 else []
    for a, b in edges:
        edge = b - a
        out = -edge.perpendicular().normalized()
        falling = along.dot(out)
        if falling >= 0:
            continue
        entry = ((a - start).dot(out) + r) / falling
        if not 0 <= entry < first:
            continue
        if 0 <= (start + along * entry - out * r - a).dot(edge) <= edge.length_squared:
            first, normal = entry, out
    if first > length:
        return None
    return SegmentQueryInfo(shape, start + along * first - normal * radius, normal, first / length)


def touch(a, b):
    """Returns the contact of two shapes by the least translation that parts them, or None if they are apart."""
    one, other, r = a._placed(), b._placed(), a.radius + b.radius
    gap, normal, pairs = _apart(one, other) or _least_overlap(one, other)
    if gap > r:
        return None
    return ContactPointSet(normal, [ContactPoint(p + normal * a.radius, q - normal * b.radius, gap - r)
                                    for p, q in pairs])


def _apart(one, other):
    """Returns distance, direction from one to the other and nearest points of two convex outlines, or None."""
    if _overlap(one, other):
        return None
    best = None
    for mine, theirs, sign in ((one, other, 1), (other, one, -1)):
        for p in mine:
            for a, b in zip(theirs, theirs[1:] + theirs[:1]):
                edge = b - a
                t = min(max((p - a).dot(edge) / edge.length_squared, 0), 1) if edge.length_squared else 0
                q = a + edge * t
                gap = (q - p).length
                if best is None or gap < best[0]:
                    best = gap, (q - p) * sign, (p, q) if sign == 1 else (q, p)
    gap, way, pair = best
    return (gap, way / gap, [pair]) if gap > 0 else None


def _axes(one, other):
    """Returns the outward normals of the edges of `one` and the inward ones of `other`."""
    for points, sign in ((one, 1), (other, -1)):
        if len(points) > 1:
            for a, b in zip(points, points[1:] + points[:1]):
                if a != b:
                    yield -(b - a).perpendicular().normalized() * sign


def _overlap(one, other):
    axes = list(_axes(one, other))
    # Lines and points have no area: across them, and along a line, they may be apart as well.
    if len(one) < 3 and len(other) < 3:
        axes = [Vec2d(1, 0)] + axes
        axes += [axis.perpendicular() for axis in axes]
        axes += [-axis for axis in axes]
    return all(max(p.dot(n) for p in one) >= min(q.dot(n) for q in other) for n in axes)


def _least_overlap(one, other):
    """Returns the distance, < 0, and direction of the least translation, and the pairs of points that are deepest."""
    best = None
    for n in _axes(one, other):
        depth = max(p.dot(n) for p in one) - min(q.dot(n) for q in other)
        if best is None or depth < best[0]:
            best = depth, n
    if best is None:  # two points in one place
        return 0.0, Vec2d(0, 1), [(one[0], other[0])]
    depth, n = best
    top, bottom = max(p.dot(n) for p in one), min(q.dot(n) for q in other)
    slack = 1e-9 * (abs(top) + abs(bottom) + depth)
    face = [p for p in one if p.dot(n) >= top - slack]
    across = [q for q in other if q.dot(n) <= bottom + slack]
    aside = n.perpendicular()
    low = max(min(p.dot(aside) for p in face), min(q.dot(aside) for q in across))
    high = min(max(p.dot(aside) for p in face), max(q.dot(aside) for q in across))
    if len(face) == 1:  # a corner in a face: where the corner is
        low = high = face[0].dot(aside)
    elif len(across) == 1:
        low = high = across[0].dot(aside)
    places = [low, high] if high > low else [(low + high) / 2]
    return -depth, n, [(n * top + aside * s, n * bottom + aside * s) for s in places]
