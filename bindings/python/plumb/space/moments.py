"""Areas, moments of inertia and convex hulls."""

import math

from plumb.space.values import Vec2d


def moment_for_circle(mass, inner_radius, outer_radius, offset=(0, 0)):
    return mass * (0.5 * (inner_radius**2 + outer_radius**2) + offset[0]**2 + offset[1]**2)


def moment_for_segment(mass, a, b, radius):
    """Returns the moment of a box as long as the segment with its rounded ends, about the origin."""
    middle = (Vec2d(*a) + b) / 2
    length = (Vec2d(*b) - a).length + 2 * radius
    return mass * ((length**2 + 4 * radius**2) / 12 + middle.length_squared)


def moment_for_poly(mass, vertices, offset=(0, 0), radius=0):
    above = below = 0.0
    points = [Vec2d(*v) + offset for v in vertices]
    if len(points) == 2:
        return moment_for_segment(mass, points[0], points[1], 0)
    for p, q in zip(points, points[1:] + points[:1]):
        area = q.cross(p)
        above += area * (p.dot(p) + p.dot(q) + q.dot(q))
        below += area
    return mass * above / (6 * below)


def moment_for_box(mass, size):
    return mass * (size[0]**2 + size[1]**2) / 12


def area_for_circle(inner_radius, outer_radius):
    return math.pi * abs(inner_radius**2 - outer_radius**2)


def area_for_segment(a, b, radius):
    return radius * (math.pi * radius + 2 * (Vec2d(*b) - a).length)


def area_for_poly(vertices, radius=0):
    points = [Vec2d(*v) for v in vertices]
    pairs = list(zip(points, points[1:] + points[:1]))
    area = sum(p.cross(q) for p, q in pairs) / 2
    round_about = sum((q - p).length for p, q in pairs)
    return radius * (math.pi * abs(radius) + round_about) + area


def hull_of(points):
    """Returns the convex hull, counter-clockwise."""
    ordered = sorted(set(map(tuple, points)))
    if len(ordered) < 3:
        return [Vec2d(*p) for p in ordered]

    def half(side):
        out = []
        for p in side:
            while len(out) > 1 and (Vec2d(*out[-1]) - out[-2]).cross(Vec2d(*p) - out[-1]) <= 0:
                out.pop()
            out.append(p)
        return out[:-1]

    return [Vec2d(*p) for p in half(ordered) + half(ordered[::-1])]
