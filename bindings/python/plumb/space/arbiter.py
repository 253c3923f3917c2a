"""Contacts as callbacks see them."""

from typing import Any, NamedTuple

from plumb.space.values import ContactPoint, ContactPointSet, Vec2d


class Arbiter:
    """Two shapes that touch, as callbacks see them."""

    def __init__(self, space, shapes, contact=None, first=False, removal=False):
        self._space = space
        self._shapes = shapes
        self._contact = contact
        self.is_first_contact = first
        self.is_removal = removal
        self.process_collision = True
        self.restitution = shapes[0].elasticity * shapes[1].elasticity
        self.friction = shapes[0].friction * shapes[1].friction

    @property
    def shapes(self):
        return self._shapes

    @property
    def bodies(self):
        return self._shapes[0].body, self._shapes[1].body

    @property
    def normal(self):
        return self.contact_point_set.normal

    @property
    def contact_point_set(self):
        c = self._contact
        if c is None:
            return ContactPointSet(Vec2d(0, 0), [])
        # Points lie half-way between the surfaces; overlap is negative.
        turned = self._space._of.get(c["shape_a"].index) is not self._shapes[0]
        normal = Vec2d(*c["normal"]) * (-1 if turned else 1)
        points = []
        for at, gap in zip(c["points"], c["separations"]):
            half = normal * (gap / 2)
            points.append(ContactPoint(Vec2d(*at) - half, Vec2d(*at) + half, gap))
        return ContactPointSet(normal, points)

    @property
    def total_impulse(self):
        c = self._contact
        return self.normal * c["step_impulse"] if c and "step_impulse" in c else Vec2d(0, 0)


class Handler(NamedTuple):
    types: tuple
    begin: Any
    pre_solve: Any
    post_solve: Any
    separate: Any
    data: Any
