"""Joints of bounded force: velocities that a constraint drives its bodies to, as Chipmunk corrects its errors."""

import math

from plumb import _plumb
from plumb.space.values import BIG

ERROR_BIAS = (1 - 0.1)**60  # Chipmunk's default: a tenth of an error goes in each 1/60 s
STIFF = 1e6  # 1/s, rate at which a driven velocity is reached: far above that of any step
_LEAD = 3.0  # rad, greatest lead of a target angle, which plumb takes modulo a turn


def correction(error, limits, dt):
    """Returns the velocity that undoes an error: the share that Chipmunk corrects in a step, up to a greatest speed."""
    bias, most = limits
    speed = error * (1 - bias**dt) / dt
    length = abs(speed)
    return speed if length <= most else speed * (most / length)


def bounded(force):
    return min(force, BIG)


def relaxing(error_bias):
    """Returns the spring (hertz, damping ratio) that lets an error decay as error_bias to the power of the time."""
    rate = -math.log(max(error_bias, 1e-40))
    if rate <= 0:
        return 1e-6, STIFF / (2 * math.tau * 1e-6)
    omega = math.sqrt(rate * STIFF)
    return omega / math.tau, STIFF / (2 * omega)


def turning(angle, speed, dt, substeps, most):
    """Returns the motor joint that turns b, now at `angle` to a, by speed * dt within a step, with a torque <= most.

    plumb's motor joint drives to an angle by a spring. An overdamped one whose target is far ahead drives to a speed:
    theta' = rate (target - theta), in implicit substeps between two half turns. The lead makes up for what the speed
    loses as the target comes nearer.
    """
    turn = speed * dt
    if abs(turn) > _LEAD - 1:
        raise NotImplementedError(
            f"A motor of {speed} rad/s without a pivot turns too far in a step of {dt} s in plumb")
    rate = max(abs(speed) / (_LEAD - abs(turn)), 1e-3)  # 1/s
    lead = turn / (1 - (1 + rate * dt / substeps)**-substeps) + turn / (2 * substeps)
    omega = math.sqrt(rate * STIFF)
    return _plumb.Motor(target_angle=angle + lead, max_torque=bounded(most),
                        spring=(omega / math.tau, STIFF / (2 * omega)))


class Carrier:
    """A kinematic body without shapes: moves as one that is not in the space, or with the velocity of a drive."""

    def __init__(self, world, position, angle=0.0):
        self.held = world.create_body(type="kinematic", position=position, angle=angle)
        self._seen = None

    def place(self, position, angle):
        if (position, angle) != (self.held.position, self.held.angle):
            self.held.set_pose(position, angle)

    def move(self, velocity, spin):
        """Sets its velocities. Returns True if they changed or are not 0: bodies must be awake for them."""
        new = (velocity[0], velocity[1], spin)
        if new != self._seen:
            self.held.velocity, self.held.angular_velocity = velocity, spin
        moving = new != self._seen or new != (0, 0, 0)
        self._seen = new
        return moving

    def destroy(self):
        if self.held.valid:
            self.held.destroy()
