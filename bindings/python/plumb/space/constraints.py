"""Joints between two bodies, each as a joint of plumb or as a part of one."""

import math

from plumb import _plumb
from plumb.space.constraint import Anchored, Constraint, field
from plumb.space.drives import bounded, correction, relaxing, turning
from plumb.space.values import BIG, Vec2d


class PinJoint(Anchored):
    def __init__(self, a, b, anchor_a=(0, 0), anchor_b=(0, 0)):
        super().__init__(a, b)
        self._anchor_a, self._anchor_b = Vec2d(*anchor_a), Vec2d(*anchor_b)
        self._distance = (b.local_to_world(anchor_b) - a.local_to_world(anchor_a)).length

    distance = field("_distance")

    def _check(self):
        if self._soft and self._distance == 0:
            raise NotImplementedError("A PinJoint of distance 0 has no max_force, max_bias and error_bias in plumb")

    def _kind(self, speed=0.0):
        anchors = {"anchor_a": self._anchor_a, "anchor_b": self._anchor_b}
        if self._distance == 0:
            return _plumb.Revolute(**anchors)
        if not self._soft:
            return _plumb.Distance(self._distance, **anchors)
        return _plumb.Distance(self._distance, range=(0, BIG), motor=(speed, bounded(self._max_force)), **anchors)

    def _ready(self, dt):
        super()._ready(dt)
        if self._soft and self._held is not None:
            one, other = self._ends()
            self._change(self._kind(correction(self._distance - (other - one).length, self._limits, dt)))


class SlideJoint(Anchored):
    def __init__(self, a, b, anchor_a, anchor_b, min, max):
        super().__init__(a, b)
        self._anchor_a, self._anchor_b, self._min, self._max = Vec2d(*anchor_a), Vec2d(*anchor_b), min, max

    min, max = field("_min"), field("_max")

    def _kind(self):
        return _plumb.Distance(self._max, anchor_a=self._anchor_a, anchor_b=self._anchor_b,
                               range=(self._min, self._max))


class _Turning:
    """Takes over the limits and motors between the same bodies, which plumb has as parts of one joint."""

    def _turns(self):
        parts = {}
        for limit in self._siblings(RotaryLimitJoint):
            low, high = (limit._min, limit._max) if limit._a is self._a else (-limit._max, -limit._min)
            before = parts.get("limits", (-math.inf, math.inf))
            parts["limits"] = max(low, before[0]), min(high, before[1])
        for motor in self._siblings(SimpleMotor):
            if motor._host() is self:
                speed = -motor._rate if motor._a is self._a else motor._rate
                parts["motor"] = speed, bounded(motor._max_force)
        return parts


class PivotJoint(_Turning, Anchored):
    def __init__(self, a, b, *args):
        super().__init__(a, b)
        if len(args) == 1:
            args = a.world_to_local(args[0]), b.world_to_local(args[0])
        assert len(args) == 2, "You must specify either one pivot point or two anchor points"
        self._anchor_a, self._anchor_b = Vec2d(*args[0]), Vec2d(*args[1])

    def _check(self):
        if not self._soft or self._moved() or self._max_bias == 0:
            return
        if self._max_bias < math.inf:
            raise NotImplementedError("A PivotJoint of two dynamic bodies has no max_bias but 0 in plumb")
        if (0, 0) not in (self._anchor_a, self._anchor_b):
            raise NotImplementedError("A PivotJoint of two dynamic bodies that has max_force or error_bias needs an "
                                      "anchor at (0, 0), or max_bias = 0, in plumb")

    def _join(self, a, b):
        anchors = {"anchor_a": self._anchor_a, "anchor_b": self._anchor_b}
        make = self._space._world.create_joint
        if not self._soft:
            return make(a, b, _plumb.Revolute(**anchors, **self._turns()), collide=self._collide)
        moved = self._moved()
        force = bounded(self._max_force)
        if moved:
            anchor = self._anchor_a if moved[0] is self._a else self._anchor_b
            return self._drive_by(moved[0], _plumb.Friction(force, 0, anchor_b=anchor))
        if self._max_bias == 0:
            return make(a, b, _plumb.Friction(force, 0, **anchors), collide=self._collide)
        spring = relaxing(self._bias)
        if self._anchor_b == (0, 0):
            return make(a, b, _plumb.Motor(target_position=self._anchor_a, max_force=force, spring=spring),
                        collide=self._collide)
        return make(b, a, _plumb.Motor(target_position=self._anchor_b, max_force=force, spring=spring),
                    collide=self._collide)

    def _ready(self, dt):
        super()._ready(dt)
        if self._drive is None:
            return
        moved, ground = self._moved()
        ends = self._ends()
        own, target = ends if moved is self._a else ends[::-1]
        self._drive.place(target, 0.0)
        velocity = ground.velocity_at_world_point(target) + correction(target - own, self._limits, dt)
        if self._drive.move(velocity, 0.0):
            moved.activate()


class GrooveJoint(_Turning, Constraint):
    def __init__(self, a, b, groove_a, groove_b, anchor_b):
        super().__init__(a, b)
        self._groove_a, self._groove_b, self._anchor_b = Vec2d(*groove_a), Vec2d(*groove_b), Vec2d(*anchor_b)

    groove_a, groove_b, anchor_b = field("_groove_a"), field("_groove_b"), field("_anchor_b")

    def _kind(self):
        way = self._groove_b - self._groove_a
        motor = self._turns().get("motor")
        return _plumb.Wheel(way, anchor_a=self._groove_a, anchor_b=self._anchor_b, limits=(0, way.length), motor=motor)


class RotaryLimitJoint(Constraint):
    """Limits of the PivotJoint between the same bodies, which must be in the space."""

    def __init__(self, a, b, min, max):
        super().__init__(a, b)
        self._min, self._max = min, max

    min, max = field("_min"), field("_max")

    def _pivot(self):
        for pivot in self._siblings(PivotJoint):
            if not pivot._soft:
                return pivot
        raise NotImplementedError("RotaryLimitJoint has no counterpart in plumb without a PivotJoint, of unbounded "
                                  "force, between the same bodies")

    def _join(self, a, b):
        self._pivot()._renew()
        return None

    def _leave(self):
        pivots = self._siblings(PivotJoint)
        super()._leave()
        for pivot in pivots:
            pivot._renew()

    def _ready(self, dt):
        self._pivot()


class RatchetJoint(Constraint):
    def __init__(self, a, b, phase, ratchet):
        super().__init__(a, b)
        self._phase, self._ratchet, self._angle = phase, ratchet, 0.0

    angle, phase, ratchet = field("_angle"), field("_phase"), field("_ratchet")

    def _kind(self):
        return _plumb.Ratchet(self._ratchet, self._phase)


class GearJoint(Constraint):
    """Keeps ratio * angle of b - angle of a at the phase."""

    def __init__(self, a, b, phase, ratio):
        super().__init__(a, b)
        self._phase, self._ratio = phase, ratio

    phase, ratio = field("_phase"), field("_ratio")

    def _check(self):
        if not self._soft or self._moved():
            return
        if self._ratio != 1 or 0 < self._max_bias < math.inf:
            raise NotImplementedError("A GearJoint of two dynamic bodies that has max_force, max_bias or error_bias "
                                      "needs ratio 1 and max_bias 0 or infinite in plumb")

    def _join(self, a, b):
        if not self._soft:
            kind = _plumb.Gear(1 / self._ratio, self._phase / self._ratio)
        elif self._moved():
            moved = self._moved()[0]
            # Chipmunk bounds the torque on b; that on a is the ratio's share of it.
            most = self._max_force if moved is self._b else self._max_force / abs(self._ratio)
            return self._drive_by(moved, _plumb.Friction(0, bounded(most)))
        elif self._max_bias == 0:
            kind = _plumb.Friction(0, bounded(self._max_force))
        else:
            kind = _plumb.Motor(target_angle=self._phase, max_torque=bounded(self._max_force),
                                spring=relaxing(self._bias))
        return self._space._world.create_joint(a, b, kind, collide=self._collide)

    def _ready(self, dt):
        super()._ready(dt)
        if self._drive is None:
            return
        moved, ground = self._moved()
        error = self._phase - (self._ratio * self._b.angle - self._a.angle)
        speed = correction(error, self._limits, dt)
        if moved is self._b:
            spin = (ground.angular_velocity + speed) / self._ratio
        else:
            spin = ground.angular_velocity * self._ratio - speed
        if self._drive.move((0, 0), spin):
            moved.activate()


class SimpleMotor(Constraint):
    """Turns a against b at the rate, as Chipmunk's motors do: b turns at -rate if a stands."""

    def __init__(self, a, b, rate):
        super().__init__(a, b)
        self._rate = rate

    rate = field("_rate")

    def _check(self):
        pass  # bias means nothing to a motor

    def _host(self):
        """Returns the joint that has this motor as its own, or None."""
        for pivot in self._siblings(PivotJoint):
            if not pivot._soft:
                return pivot if pivot._siblings(SimpleMotor)[:1] == [self] else None
        for groove in self._siblings(GrooveJoint):
            if groove._a is self._a:
                return groove if groove._siblings(SimpleMotor)[:1] == [self] else None
        return None

    def _join(self, a, b):
        moved = self._moved()
        if moved is None and self._host() is not None:
            self._host()._renew()
            return None
        if moved:
            return self._drive_by(moved[0], _plumb.Friction(0, bounded(self._max_force)))
        return self._space._world.create_joint(a, b, self._turning(0, 1 / 60), collide=True)

    def _turning(self, speed, dt):
        return turning(self._b.angle - self._a.angle, speed, dt, self._space._substeps, self._max_force)

    def _leave(self):
        hosts = self._siblings((PivotJoint, GrooveJoint))
        super()._leave()
        for host in hosts:
            host._renew()

    def _ready(self, dt):
        super()._ready(dt)
        moved = self._moved()
        if self._drive is not None:
            spin = moved[1].angular_velocity + (-self._rate if moved[0] is self._b else self._rate)
            if self._drive.move((0, 0), spin):
                moved[0].activate()
        if moved is not None:
            return
        hosted = self._host() is not None
        if hosted == (self._held is not None):  # its pivot came or went
            self._drop()
            self._make()
        if not hosted and self._held is not None:
            self._change(self._turning(-self._rate, dt))
