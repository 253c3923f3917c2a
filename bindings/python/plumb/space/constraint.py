"""The base of all constraints: two bodies, limits of force and correction, and the joint in the world."""

import math

from plumb import _plumb
from plumb.space.bodies import Body
from plumb.space.drives import ERROR_BIAS, Carrier
from plumb.space.values import InSpace, Vec2d, number


class Constraint(InSpace):
    def __init__(self, a, b):
        assert Body.DYNAMIC in (a._type, b._type), "At least one of the two bodies must be dynamic."
        self._a, self._b = a, b
        self._held = None
        self._max_force = math.inf
        self._bias = ERROR_BIAS
        self._max_bias = math.inf
        self._collide = True
        self._carriers: dict = {}  # of bodies that are not in the space
        self._drive = None  # the body that drives the joint's velocity
        self._parting = None  # joint that keeps the two from colliding, where the joint of the constraint cannot
        self.pre_solve = self.post_solve = None
        a._constraints[self] = None
        b._constraints[self] = None

    a = property(lambda self: self._a)
    b = property(lambda self: self._b)

    def _limit(name):
        def put(self, value):
            value = number(type(self).__name__, {"_bias": "error_bias"}.get(name, name[1:]), value, 0, unbounded=True)
            before = getattr(self, name)
            setattr(self, name, value)
            if value != before and self._space is not None:
                try:
                    self._check()
                except NotImplementedError:
                    setattr(self, name, before)
                    raise
                self._renew()

        return property(lambda self: getattr(self, name), put)

    max_force, error_bias, max_bias = _limit("_max_force"), _limit("_bias"), _limit("_max_bias")
    del _limit

    @property
    def collide_bodies(self):
        return self._collide

    @collide_bodies.setter
    def collide_bodies(self, on):
        self._collide = bool(on)
        self._renew()

    @property
    def impulse(self):
        """The joint's reaction over the last step."""
        if self._held is None:
            return 0.0
        reading = self._held.read()
        return (reading["force"] or reading["torque"]) * self._space.current_time_step

    def activate_bodies(self):
        self._a.activate(), self._b.activate()

    # Bounded force and slow correction.
    @property
    def _soft(self):
        return self._max_force < math.inf or self._bias != ERROR_BIAS or self._max_bias < math.inf

    @property
    def _limits(self):
        return self._bias, self._max_bias

    def _check(self):
        """Raises NotImplementedError for limits that plumb's joint does not have."""
        if self._soft:
            raise NotImplementedError(
                f"{type(self).__name__} with max_force, max_bias or error_bias has no counterpart in plumb")

    def _kind(self):
        raise NotImplementedError(f"{type(self).__name__} has no counterpart in plumb")

    def _siblings(self, kind):
        """Returns the constraints of a kind between the same two bodies in this space."""
        return [j for j in self._a._constraints
                if j is not self and isinstance(j, kind) and j._space is self._space is not None
                and {j._a, j._b} == {self._a, self._b}]

    # In a space.
    def _renew(self):
        space = self._space
        if space is not None:
            space._do(lambda: (self._drop(), self._make()) if self._space is space else None)

    def _enter(self, space):
        self._space = space
        try:
            self._make()
        except Exception:
            self._leave()
            raise

    def _body(self, body):
        """Returns the world's body, or one in its place for a static or kinematic body that is not in the space."""
        if body._held is not None and body._space is self._space:
            return body._held
        if body._type == Body.DYNAMIC:
            return None
        if body not in self._carriers:
            self._carriers[body] = Carrier(self._space._world, body.position, body.angle)
        return self._carriers[body].held

    def _make(self):
        self._check()
        a, b = self._body(self._a), self._body(self._b)
        if a is not None and b is not None:
            self._held = self._join(a, b)
            if not self._collide and (self._held is None or self._drive is not None):
                self._parting = self._space._world.create_joint(a, b, _plumb.Friction(0, 0), collide=False)

    def _join(self, a, b):
        kind = self._kind()
        return kind and self._space._world.create_joint(a, b, kind, collide=self._collide)

    def _drop(self):
        for joint in (self._held, self._parting):
            if joint is not None and joint.valid:
                joint.destroy()
        for carrier in (*self._carriers.values(), *([self._drive] if self._drive else [])):
            carrier.destroy()
        self._carriers.clear()
        self._held = self._drive = self._parting = None

    def _leave(self):
        self._drop()
        self._space = None

    def _ready(self, dt):
        """Prepares a step of dt."""
        for body in (self._a, self._b):
            if body._type == Body.DYNAMIC and body._space is not self._space:
                raise NotImplementedError("A constraint's dynamic bodies must be in its space in plumb")
        for body, carrier in self._carriers.items():
            carrier.place(body.position, body.angle)
            if carrier.move(body.velocity, body.angular_velocity):
                self.activate_bodies()

    def _change(self, kind):
        """Gives the joint another target, unless it has it: a change wakes the bodies."""
        if repr(kind) != repr(self._held.kind):
            self._held.change(kind)

    def _masses_changed(self):
        pass

    # Drives, where one body is static or kinematic.
    def _moved(self):
        """Returns the dynamic body, its own anchor and those of the other one, or None if both are dynamic."""
        if self._a._type != Body.DYNAMIC:
            return self._b, self._a
        return (self._a, self._b) if self._b._type != Body.DYNAMIC else None

    def _drive_by(self, moved, friction):
        body = self._body(moved)
        if body is None:
            return None
        self._drive = Carrier(self._space._world, body.position)
        return self._space._world.create_joint(self._drive.held, body, friction, collide=True)


def field(name):
    def put(self, value):
        setattr(self, name, Vec2d(*value) if isinstance(value, tuple) else value)
        self._renew()

    return property(lambda self: getattr(self, name), put)


class Anchored(Constraint):
    anchor_a, anchor_b = field("_anchor_a"), field("_anchor_b")

    def _ends(self):
        return self._a.local_to_world(self._anchor_a), self._b.local_to_world(self._anchor_b)
