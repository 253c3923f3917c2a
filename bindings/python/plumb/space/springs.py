"""Springs between two bodies."""

import math

from plumb import _plumb
from plumb.space.bodies import Body
from plumb.space.constraint import Anchored, Constraint, field
from plumb.space.values import BIG, Vec2d


class _Spring(Constraint):
    """A spring by stiffness and damping, for any masses. As in Chipmunk, its force has no limit."""

    stiffness, damping = field("_stiffness"), field("_damping")

    def _check(self):
        pass

    def _masses_changed(self):
        self._renew()

    def _spring(self, mass):
        """Returns (hertz, damping ratio), which plumb's springs are given by, or None without a force."""
        if mass == 0 or (self._stiffness <= 0 and self._damping <= 0):
            return None
        # A damper alone is a spring too soft to matter: damping^2 / (4 mass stiffness) is its ratio squared.
        omega = math.sqrt(self._stiffness / mass) if self._stiffness > 0 else 1e-6 * self._damping / mass
        return omega / math.tau, self._damping / (2 * mass * omega)


class DampedSpring(_Spring, Anchored):
    def __init__(self, a, b, anchor_a, anchor_b, rest_length, stiffness, damping):
        super().__init__(a, b)
        self._anchor_a, self._anchor_b = Vec2d(*anchor_a), Vec2d(*anchor_b)
        self._rest, self._stiffness, self._damping = rest_length, stiffness, damping

    rest_length = field("_rest")

    def _effective_mass(self):
        """Mass at the anchors along the line between them."""
        ends = self._ends()
        n = (ends[1] - ends[0]).normalized()
        if n == (0, 0):
            n = Vec2d(1, 0)
        inverse = 0.0
        for body, at in zip((self._a, self._b), ends):
            if body._type == Body.DYNAMIC:
                mass, moment, _ = body._mass_now()
                if mass <= 0 or moment <= 0:
                    return 0.0  # until its shapes come
                inverse += 1 / mass + (at - body._centre()).cross(n)**2 / moment
        return 1 / inverse if inverse else 0.0

    def _kind(self):
        spring = self._spring(self._effective_mass())
        return spring and _plumb.Distance(max(self._rest, 1e-6), anchor_a=self._anchor_a, anchor_b=self._anchor_b,
                                          spring=spring)


class DampedRotarySpring(_Spring):
    def __init__(self, a, b, rest_angle, stiffness, damping):
        super().__init__(a, b)
        self._rest, self._stiffness, self._damping = rest_angle, stiffness, damping

    rest_angle = field("_rest")

    def _kind(self):
        moments = [body._mass_now()[1] for body in (self._a, self._b) if body._type == Body.DYNAMIC]
        inverse = sum(1 / moment for moment in moments if moment > 0)
        spring = self._spring(1 / inverse if inverse and min(moments) > 0 else 0.0)
        return spring and _plumb.Motor(target_angle=-self._rest, max_torque=BIG, spring=spring)
