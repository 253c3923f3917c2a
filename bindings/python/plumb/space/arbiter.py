"""Contacts as callbacks see them."""

from typing import Any, NamedTuple

from plumb.space.values import ContactPoint, ContactPointSet, Vec2d


class Arbiter:
    """Two shapes that touch, as callbacks see them."""

    def __init__(self, space, shapes, contact=None, first=False, removal=False, process=True):
        self._space = space
        self._shapes = shapes
        self._contact = contact
        self.is_first_contact = first
        self.is_removal = removal
        self.process_collision = process

    @property
    def shapes(self):
        return self._shapes

    @property
    def bodies(self):
        return self._shapes[0].body, self._shapes[1].body

    def _fixed(self, _):
        raise NotImplementedError(
            "A contact's own restitution, friction, surface_velocity and contact_point_set cannot be set in plumb: set "
            "those of the shapes, or process_collision")

    restitution = property(lambda self: self._shapes[0].elasticity * self._shapes[1].elasticity, _fixed)
    friction = property(lambda self: self._shapes[0].friction * self._shapes[1].friction, _fixed)

    def _surface(self):
        slip = self._shapes[0].surface_velocity - self._shapes[1].surface_velocity
        normal = self.normal
        return slip - normal * slip.dot(normal)

    surface_velocity = property(_surface, _fixed)

    @property
    def normal(self):
        return self.contact_point_set.normal

    @property
    def contact_point_set(self):
        c = self._contact
        if c is None:
            return ContactPointSet(Vec2d(0, 0), [])
        if isinstance(c, ContactPointSet):
            return c
        # Points lie half-way between the surfaces; overlap is negative.
        turned = self._space._of.get(c["shape_a"].index) is not self._shapes[0]
        normal = Vec2d(*c["normal"]) * (-1 if turned else 1)
        points = []
        for at, gap in zip(c["points"], c["separations"]):
            half = normal * (gap / 2)
            points.append(ContactPoint(Vec2d(*at) - half, Vec2d(*at) + half, gap))
        return ContactPointSet(normal, points)

    contact_point_set = contact_point_set.setter(_fixed)

    @property
    def total_impulse(self):
        """The impulse on the first shape in the last step, along the normal, without that of friction."""
        c = self._contact
        return self.normal * -c["step_impulse"] if isinstance(c, dict) else Vec2d(0, 0)


class Handler(NamedTuple):
    types: tuple
    begin: Any
    pre_solve: Any
    post_solve: Any
    separate: Any
    data: Any
