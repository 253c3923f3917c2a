"""Body."""

from __future__ import annotations

import math

from plumb.space.values import InSpace, Vec2d, number, refuse, vector


class Body(InSpace):
    DYNAMIC, KINEMATIC, STATIC = 0, 1, 2
    _TYPES = {DYNAMIC: "dynamic", KINEMATIC: "kinematic", STATIC: "static"}
    _names = {DYNAMIC: "DYNAMIC", KINEMATIC: "KINEMATIC", STATIC: "STATIC"}

    def __init__(self, mass: float = 0, moment: float = 0, body_type: int = DYNAMIC) -> None:
        self._held = None
        self._idle = 0.0  # s, for which it was slow
        self._known_mass = None  # that the world's body has
        self._type = self._known_type(body_type)
        self._mass, self._moment = float(mass), float(moment)
        self._cog = Vec2d(0, 0)
        self._position, self._angle = Vec2d(0, 0), 0.0
        self._velocity, self._spin = Vec2d(0, 0), 0.0
        self._force, self._torque = Vec2d(0, 0), 0.0
        self._shapes: dict = {}  # in the order in which they came
        self._constraints: dict = {}

    def __repr__(self):
        if self._type != Body.DYNAMIC:
            return f"Body(Body.{self._names[self._type]})"
        return f"Body({self._mass}, {self._moment}, Body.DYNAMIC)"

    @classmethod
    def _known_type(cls, body_type):
        if not isinstance(body_type, int) or body_type not in cls._TYPES:
            refuse("body", "body_type", body_type, "must be Body.DYNAMIC, Body.KINEMATIC or Body.STATIC")
        return body_type

    def _require_mass(self):
        """Refuses a dynamic body that cannot move, before a step."""
        mass, moment, _ = self._mass_now()
        name = f"{self!r} at ({self.position.x:g}, {self.position.y:g})"
        if not 0 < mass < math.inf:
            refuse(name, "mass", mass, "Dynamic bodies must have a mass > 0, given or by their shapes.")
        if not moment > 0:
            refuse(name, "moment", moment, "Dynamic bodies must have a moment > 0, given or by their shapes.")

    # Mass: as given, or of the shapes that have one.
    def _weights(self):
        return [s for s in self._shapes if s.mass > 0]

    def _mass_now(self):
        parts = self._weights()
        if not parts:
            return self._mass, self._moment, self._cog
        mass = sum(s.mass for s in parts)
        cog = sum((s.center_of_gravity * s.mass for s in parts), Vec2d(0, 0)) / mass
        moment = sum(s.moment + s.mass * (s.center_of_gravity - cog).length_squared for s in parts)
        return mass, moment, cog

    def _update_mass(self):
        if self._held is None or self._type != Body.DYNAMIC:
            return
        mass, moment, cog = self._mass_now()
        if not (0 < mass < math.inf and moment > 0):
            return  # refused by the step, as pymunk does
        if (mass, moment, cog) == self._known_mass:
            return
        self._known_mass = mass, moment, cog
        self._do(self._pass_mass)
        for joint in self._constraints:
            joint._masses_changed()

    def _pass_mass(self):
        mass, moment, cog = self._known_mass
        turns = moment < math.inf
        self._held.set_mass(mass, moment if turns else 1.0, cog)
        self._held.set_locks(rotation=not turns)

    def _do(self, action):
        """Acts on the world's body if there is one: at the end of the step for callbacks from within one."""
        if self._held is not None:
            space = self._space
            if space is None:
                action()  # its space is gone
            else:
                space._do(lambda: action() if self._held is not None else None)

    @property
    def mass(self):
        return self._mass_now()[0]

    @mass.setter
    def mass(self, mass):
        assert self._space is None or 0 < mass < math.inf, "Dynamic bodies must have a mass > 0 if they are in a space."
        self._mass = float(mass)
        self._update_mass()

    @property
    def moment(self):
        return self._mass_now()[1]

    @moment.setter
    def moment(self, moment):
        assert self._space is None or moment > 0, "Dynamic bodies must have a moment > 0 if they are in a space."
        self._moment = float(moment)
        self._update_mass()

    @property
    def center_of_gravity(self):
        return self._mass_now()[2]

    @center_of_gravity.setter
    def center_of_gravity(self, cog):
        self._cog = Vec2d(*cog)
        self._update_mass()

    @property
    def position(self):
        return Vec2d(*self._held.position) if self._held else self._position

    @position.setter
    def position(self, position):
        assert len(position) == 2
        self._position = Vec2d(*position)
        self._do(lambda: setattr(self._held, "position", Vec2d(*position)))

    @property
    def angle(self):
        return self._held.angle if self._held else self._angle

    @angle.setter
    def angle(self, angle):
        self._angle = float(angle)
        self._do(lambda: setattr(self._held, "angle", float(angle)))

    @property
    def velocity(self):
        return Vec2d(*self._held.velocity) if self._held else self._velocity

    @velocity.setter
    def velocity(self, velocity):
        assert len(velocity) == 2
        self._velocity = Vec2d(*velocity)
        if self._type != Body.STATIC:
            self._do(lambda: setattr(self._held, "velocity", Vec2d(*velocity)))

    @property
    def angular_velocity(self):
        return self._held.angular_velocity if self._held else self._spin

    @angular_velocity.setter
    def angular_velocity(self, spin):
        self._spin = float(spin)
        if self._type != Body.STATIC:
            self._do(lambda: setattr(self._held, "angular_velocity", float(spin)))

    @property
    def force(self):
        return self._force

    @force.setter
    def force(self, force):
        self._force = vector("body", "force", force)

    @property
    def torque(self):
        return self._torque

    @torque.setter
    def torque(self, torque):
        self._torque = number("body", "torque", torque)

    def _no_function(name):
        def put(self, function):
            raise NotImplementedError(f"{name} has no counterpart in plumb, which moves bodies by itself; set velocities and "
                                      f"forces between steps")

        return property(None, put)

    velocity_func, position_func = _no_function("velocity_func"), _no_function("position_func")
    del _no_function

    @property
    def rotation_vector(self):
        return Vec2d.from_polar(1, self.angle)

    @property
    def kinetic_energy(self):
        """Returns m v^2 + I w^2, without the half, as pymunk does."""
        turns = 0 if self.angular_velocity == 0 else self.angular_velocity**2 * self.moment
        return self.velocity.length_squared * self.mass + turns

    @property
    def body_type(self):
        return self._type

    @body_type.setter
    def body_type(self, body_type):
        self._known_type(body_type)
        for joint in self._constraints:
            other = joint._b if joint._a is self else joint._a
            assert Body.DYNAMIC in (body_type, other._type), "At least one body of a constraint must be dynamic."
        self._type = body_type
        if self._held:
            self._known_mass = None
            self._do(lambda: setattr(self._held, "type", self._TYPES[body_type]))
            self._update_mass()
            for joint in self._constraints:
                joint._renew()

    @property
    def space(self):
        return self._space

    @property
    def shapes(self):
        return set(self._shapes)

    @property
    def constraints(self):
        return set(self._constraints)

    @property
    def is_sleeping(self):
        return self._held is not None and not self._held.awake

    def activate(self):
        if self._type == Body.DYNAMIC:
            self._do(lambda: setattr(self._held, "awake", True))

    def sleep(self):
        if self._held is None:
            raise Exception("Body not added to a space")
        self._do(lambda: setattr(self._held, "awake", False))

    def _let_sleep(self, may):
        if self._held.may_sleep != may:
            self._held.may_sleep = may

    def local_to_world(self, v):
        return Vec2d(*v).rotated(self.angle) + self.position

    def world_to_local(self, v):
        return (Vec2d(*v) - self.position).rotated(-self.angle)

    def _centre(self):
        return self.local_to_world(self.center_of_gravity)

    def velocity_at_world_point(self, point):
        return self.velocity + (Vec2d(*point) - self._centre()).perpendicular() * self.angular_velocity

    def velocity_at_local_point(self, point):
        return self.velocity_at_world_point(self.local_to_world(point))

    def apply_force_at_world_point(self, force, point):
        self.activate()
        self.force += force
        self.torque += (Vec2d(*point) - self._centre()).cross(force)

    def apply_force_at_local_point(self, force, point=(0, 0)):
        self.apply_force_at_world_point(Vec2d(*force).rotated(self.angle), self.local_to_world(point))

    def apply_impulse_at_world_point(self, impulse, point):
        if self._space is not None and self._space._in_world:
            arm = Vec2d(*point) - self._centre()
            self._do(lambda: self.apply_impulse_at_world_point(impulse, self._centre() + arm))
            return
        self.activate()
        mass, moment, _ = self._mass_now()
        self.velocity = self.velocity + Vec2d(*impulse) / mass
        self.angular_velocity = self.angular_velocity + (Vec2d(*point) - self._centre()).cross(impulse) / moment

    def apply_impulse_at_local_point(self, impulse, point=(0, 0)):
        self.apply_impulse_at_world_point(Vec2d(*impulse).rotated(self.angle), self.local_to_world(point))

    def each_arbiter(self, function, *args, **kwargs):
        space = self._space
        for contact in self._held.contacts() if space is not None else ():
            function(space._arbiter_of(contact, self), *args, **kwargs)

    def _enter(self, space):
        self._space = space
        self._held = space._world.create_body(type=self._TYPES[self._type], position=self._position, angle=self._angle,
                                              velocity=self._velocity, angular_velocity=self._spin,
                                              mass=(1.0, 1.0, (0, 0)) if self._type == Body.DYNAMIC else None,
                                              may_sleep=not 0.5 < space._sleep_time < math.inf)
        self._idle = 0.0
        self._held.linear_damping = self._held.angular_damping = space._rate()
        self._known_mass = None
        self._update_mass()

    def _leave(self):
        self._position, self._angle = self.position, self.angle
        self._velocity, self._spin = self.velocity, self.angular_velocity
        held, self._held, self._space = self._held, None, None
        held.destroy()
