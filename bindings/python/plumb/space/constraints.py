"""Constraints between two bodies, each as a joint of plumb."""

import math

from plumb import _plumb
from plumb.space.bodies import Body
from plumb.space.values import BIG, Vec2d


class Constraint:
    def __init__(self, a, b):
        assert Body.DYNAMIC in (a._type, b._type), "At least one of the two bodies must be dynamic."
        self._a, self._b = a, b
        self._held = None
        self._space = None
        self._max_force = math.inf
        self._bias = (1 - 0.1)**60
        self._max_bias = math.inf
        self._collide = True
        self.pre_solve = self.post_solve = None
        a._constraints[self] = None
        b._constraints[self] = None

    a = property(lambda self: self._a)
    b = property(lambda self: self._b)
    max_force = property(lambda self: self._max_force, lambda self, value: setattr(self, "_max_force", value))
    error_bias = property(lambda self: self._bias, lambda self, value: setattr(self, "_bias", value))
    max_bias = property(lambda self: self._max_bias, lambda self, value: setattr(self, "_max_bias", value))

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

    def _kind(self):
        raise NotImplementedError(f"{type(self).__name__} has no counterpart in plumb")

    def _renew(self):
        if self._held is not None:
            self._held.destroy()
            self._enter(self._space)

    def _enter(self, space):
        self._space = space
        if self._a._held and self._b._held:
            self._held = space._world.create_joint(self._a._held, self._b._held, self._kind(), collide=self._collide)

    def _leave(self):
        if self._held is not None and self._held.valid:
            self._held.destroy()
        self._held = self._space = None

    def _effective_mass(self, anchor_a, anchor_b):
        """Mass at the anchors along the line between them."""
        pa, pb = self._a.local_to_world(anchor_a), self._b.local_to_world(anchor_b)
        n = (pb - pa).normalized() or Vec2d(1, 0)
        inverse = 0.0
        for body, at in ((self._a, pa), (self._b, pb)):
            if body._type == Body.DYNAMIC:
                mass, moment, _ = body._mass_now()
                inverse += 1 / mass + (at - body._centre()).cross(n)**2 / moment
        return 1 / inverse if inverse else 1.0


def _field(name):
    def put(self, value):
        setattr(self, name, Vec2d(*value) if isinstance(value, tuple) else value)
        self._renew()

    return property(lambda self: getattr(self, name), put)


class PinJoint(Constraint):
    def __init__(self, a, b, anchor_a=(0, 0), anchor_b=(0, 0)):
        super().__init__(a, b)
        self._anchor_a, self._anchor_b = Vec2d(*anchor_a), Vec2d(*anchor_b)
        self._distance = (b.local_to_world(anchor_b) - a.local_to_world(anchor_a)).length

    anchor_a, anchor_b, distance = _field("_anchor_a"), _field("_anchor_b"), _field("_distance")

    def _kind(self):
        if self._distance == 0:
            return _plumb.Revolute(anchor_a=self._anchor_a, anchor_b=self._anchor_b)
        return _plumb.Distance(self._distance, anchor_a=self._anchor_a, anchor_b=self._anchor_b)


class SlideJoint(Constraint):
    def __init__(self, a, b, anchor_a, anchor_b, min, max):
        super().__init__(a, b)
        self._anchor_a, self._anchor_b, self._min, self._max = Vec2d(*anchor_a), Vec2d(*anchor_b), min, max

    anchor_a, anchor_b, min, max = _field("_anchor_a"), _field("_anchor_b"), _field("_min"), _field("_max")

    def _kind(self):
        return _plumb.Distance(self._max, anchor_a=self._anchor_a, anchor_b=self._anchor_b,
                               range=(self._min, self._max))


class PivotJoint(Constraint):
    def __init__(self, a, b, *args):
        super().__init__(a, b)
        if len(args) == 1:
            args = a.world_to_local(args[0]), b.world_to_local(args[0])
        assert len(args) == 2, "You must specify either one pivot point or two anchor points"
        self._anchor_a, self._anchor_b = Vec2d(*args[0]), Vec2d(*args[1])

    anchor_a, anchor_b = _field("_anchor_a"), _field("_anchor_b")

    def _kind(self):
        return _plumb.Revolute(anchor_a=self._anchor_a, anchor_b=self._anchor_b)


class GrooveJoint(Constraint):
    def __init__(self, a, b, groove_a, groove_b, anchor_b):
        super().__init__(a, b)
        self._groove_a, self._groove_b, self._anchor_b = Vec2d(*groove_a), Vec2d(*groove_b), Vec2d(*anchor_b)

    groove_a, groove_b, anchor_b = _field("_groove_a"), _field("_groove_b"), _field("_anchor_b")

    def _kind(self):
        way = self._groove_b - self._groove_a
        return _plumb.Wheel(way, anchor_a=self._groove_a, anchor_b=self._anchor_b, limits=(0, way.length))


class DampedSpring(Constraint):
    def __init__(self, a, b, anchor_a, anchor_b, rest_length, stiffness, damping):
        super().__init__(a, b)
        self._anchor_a, self._anchor_b = Vec2d(*anchor_a), Vec2d(*anchor_b)
        self._rest, self._stiffness, self._damping = rest_length, stiffness, damping

    anchor_a, anchor_b, rest_length = _field("_anchor_a"), _field("_anchor_b"), _field("_rest")
    stiffness, damping = _field("_stiffness"), _field("_damping")

    def _kind(self):
        # plumb's springs are given by frequency and damping ratio, with the mass that the anchors feel.
        mass = self._effective_mass(self._anchor_a, self._anchor_b)
        rate = math.sqrt(self._stiffness / mass)
        return _plumb.Distance(max(self._rest, 1e-6), anchor_a=self._anchor_a, anchor_b=self._anchor_b,
                               spring=(rate / math.tau, self._damping / (2 * mass * rate)))


class DampedRotarySpring(Constraint):
    def __init__(self, a, b, rest_angle, stiffness, damping):
        super().__init__(a, b)
        self._rest, self._stiffness, self._damping = rest_angle, stiffness, damping

    rest_angle, stiffness, damping = _field("_rest"), _field("_stiffness"), _field("_damping")

    def _kind(self):
        inverse = sum(1 / body._mass_now()[1] for body in (self._a, self._b) if body._type == Body.DYNAMIC)
        moment = 1 / inverse if inverse else 1.0
        rate = math.sqrt(self._stiffness / moment)
        return _plumb.Motor(target_angle=-self._rest, max_torque=BIG,
                            spring=(rate / math.tau, self._damping / (2 * moment * rate)))


class RotaryLimitJoint(Constraint):
    def __init__(self, a, b, min, max):
        super().__init__(a, b)
        self._min, self._max = min, max

    min, max = _field("_min"), _field("_max")


class RatchetJoint(Constraint):
    def __init__(self, a, b, phase, ratchet):
        super().__init__(a, b)
        self._phase, self._ratchet, self._angle = phase, ratchet, 0.0

    angle, phase, ratchet = _field("_angle"), _field("_phase"), _field("_ratchet")

    def _kind(self):
        return _plumb.Ratchet(self._ratchet, self._phase)


class GearJoint(Constraint):
    def __init__(self, a, b, phase, ratio):
        super().__init__(a, b)
        self._phase, self._ratio = phase, ratio

    phase, ratio = _field("_phase"), _field("_ratio")

    def _kind(self):
        return _plumb.Gear(1 / self._ratio, self._phase / self._ratio)


class SimpleMotor(Constraint):
    def __init__(self, a, b, rate):
        super().__init__(a, b)
        self._rate = rate

    rate = _field("_rate")
