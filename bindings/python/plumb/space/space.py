"""Space: the bodies, shapes and constraints of a world of plumb, its callbacks and queries."""

from __future__ import annotations

import itertools
import math

from plumb import _plumb
from plumb.space.bodies import Body
from plumb.space.collisions import Collisions
from plumb.space.constraint import Constraint
from plumb.space.constraints import RotaryLimitJoint
from plumb.space.queries import Queries
from plumb.space.shapes import Shape
from plumb.space.values import BIG, Vec2d, number, refuse, vector

PLUMBS_SLEEP_TIME = 0.5  # s, for which a body is slow before it sleeps


class Space(Collisions, Queries):
    def __init__(self, threaded: bool = False) -> None:
        # Chipmunk multiplies both coefficients.
        self._world = _plumb.World(gravity=(0, 0), precision="double", sleeping=False, combine_friction="product",
                                   combine_restitution="product", thresholds=(0, -1, -1))
        self._threaded = threaded
        self._of: dict[int, Shape] = {}  # by the index of plumb's shape
        self._bodies: dict[Body, None] = {}
        self._shapes: dict[Shape, None] = {}
        self._constraints: dict[Constraint, None] = {}
        self._waiting: list = []  # additions and removals from within a step
        self._post_step: dict = {}
        self._stepping = False
        self._damping, self._sleep_time = 1.0, math.inf
        self._iterations, self._substeps = 10, 4
        self._idle_speed = 0.0
        self._forces: dict = {}  # of the present step
        self._ages = itertools.count()
        self.current_time_step = 0.0
        self._static_body = Body(body_type=Body.STATIC)
        self._start_collisions()
        self._static_body._enter(self)

    def __reduce_ex__(self, protocol):
        raise NotImplementedError("a Space cannot be copied or pickled in plumb")

    static_body = property(lambda self: self._static_body)
    bodies = property(lambda self: list(self._bodies))
    shapes = property(lambda self: list(self._shapes))
    constraints = property(lambda self: list(self._constraints))

    @property
    def gravity(self):
        return Vec2d(*self._world.gravity)

    @gravity.setter
    def gravity(self, gravity):
        gravity = vector("space", "gravity", gravity)
        self._do(lambda: setattr(self._world, "gravity", gravity))

    @property
    def damping(self):
        """The share of a velocity that is left after a second."""
        return self._damping

    @damping.setter
    def damping(self, damping):
        self._damping = number("space", "damping", damping, 0, 1)
        self._do(self._pass_damping)

    def _pass_damping(self):
        for body in self._bodies:
            body._held.linear_damping = body._held.angular_damping = self._rate()

    def _rate(self):
        return max(-math.log(self._damping), 0.0) if self._damping > 0 else BIG

    @property
    def sleep_time_threshold(self):
        return self._sleep_time

    @sleep_time_threshold.setter
    def sleep_time_threshold(self, seconds):
        self._sleep_time = seconds = number("space", "sleep_time_threshold", seconds, 0, unbounded=True)
        self._do(lambda: self._world.set_sleeping(seconds < math.inf))
        for body in self._bodies:
            body._idle = 0.0
            body._do(lambda body=body: body._let_sleep(self._sleep_time <= PLUMBS_SLEEP_TIME))

    @property
    def idle_speed_threshold(self):
        """Speed up to which a body may fall asleep; 0: as plumb has it, by the shapes' sizes."""
        return self._idle_speed

    @idle_speed_threshold.setter
    def idle_speed_threshold(self, speed):
        self._idle_speed = speed = number("space", "idle_speed_threshold", speed, 0)
        self._do(lambda: setattr(self._world, "thresholds", (0, -1, speed if speed > 0 else -1)))

    @property
    def iterations(self):
        """Work on each step: plumb takes 4 substeps for 10 iterations, and others in proportion."""
        return self._iterations

    @iterations.setter
    def iterations(self, count):
        if not isinstance(count, int) or not 1 <= count <= 2500:
            refuse("space", "iterations", count, "must be a whole number from 1 to 2500, which are 1000 substeps")
        self._iterations = count
        self._substeps = max(1, math.ceil(count * 4 / 10))

    def _only(name, value):
        def put(self, given):
            if given != value:
                raise NotImplementedError(f"{name} has no counterpart in plumb: contacts keep an overlap by their "
                                          f"shapes' sizes, and correct it by themselves")

        return property(lambda self: value, put)

    collision_slop = _only("collision_slop", 0.1)
    collision_bias = _only("collision_bias", (1 - 0.1)**60)
    collision_persistence = _only("collision_persistence", 3)
    del _only

    @property
    def threads(self):
        return self._world.threads

    @threads.setter
    def threads(self, count):
        if self._threaded:
            self._world.threads = count

    def use_spatial_hash(self, dim, count):
        """Does nothing: plumb's tree needs no hint."""

    def reindex_shape(self, shape):
        """Does nothing: shapes are always where their bodies are."""

    reindex_shapes_for_body = reindex_shape

    def reindex_static(self):
        """Does nothing."""

    # Adding and removing.
    def add(self, *objects):
        if self._stepping:
            self._waiting.append((self.add, objects))
            return
        adding = {0: self._add_body, 1: self._add_shape, 2: self._add_constraint, 3: self._add_constraint}
        for each in sorted(objects, key=self._turn_of):
            adding[self._turn_of(each)](each)

    @staticmethod
    def _turn_of(each):
        """Returns when to add it among others: what needs others comes after them."""
        for turn, kind in ((0, Body), (1, Shape), (3, RotaryLimitJoint), (2, Constraint)):
            if isinstance(each, kind):
                return turn
        raise TypeError(f"a space has bodies, shapes and constraints, not {each!r}")

    def _add_body(self, body):
        assert body not in self._bodies, "Body already added to this space."
        assert body._space is None, "Body already added to another space."
        self._bodies[body] = None
        body._enter(self)
        for joint in body._constraints:
            joint._renew()

    def _add_shape(self, shape):
        assert shape._space is not self, "Shape already added to this space."
        assert shape._space is None, "Shape already added to another space."
        assert shape._body is not None, "The shape's body is not set."
        assert shape._body._space is self, "The shape's body must be added to the space before (or with) the shape."
        self._shapes[shape] = None
        shape._space, shape._age = self, next(self._ages)
        shape._enter_world()
        shape._body._update_mass()

    def _add_constraint(self, joint):
        assert joint not in self._constraints, "Constraint already added to this space."
        joint._enter(self)
        self._constraints[joint] = None

    def remove(self, *objects):
        if self._stepping:
            self._waiting.append((self.remove, objects))
            return
        self._stepping = True  # a separate callback that removes something does so afterwards
        try:
            taking = {0: self._remove_body, 1: self._remove_shape, 2: self._remove_constraint,
                      3: self._remove_constraint}
            for each in sorted(objects, key=self._turn_of, reverse=True):
                taking[self._turn_of(each)](each)
        finally:
            self._stepping = False
        self._do_waiting()

    def _remove_body(self, body):
        assert body in self._bodies, "body not in space, already removed?"
        for joint in body._constraints:
            joint._drop()
        for shape in [s for s in body._shapes if s._held]:
            for pair in [pair for pair in self._touching if shape in pair]:
                self._end(pair, True)
            del self._of[shape._held.index]
            shape._held = None  # destroyed with the body
        del self._bodies[body]
        body._leave()
        for joint in body._constraints:
            joint._renew()

    def _remove_shape(self, shape):
        assert shape in self._shapes, "shape not in space, already removed?"
        del self._shapes[shape]
        self._belts.pop(shape, None)
        for pair in [pair for pair in self._touching if shape in pair]:
            if pair in self._touching:
                self._end(pair, True)
        shape._space = None
        if shape._held:
            del self._of[shape._held.index]
            if shape._held.valid:
                shape._held.destroy()
            shape._held = None

    def _remove_constraint(self, joint):
        assert joint in self._constraints, "constraint not in space, already removed?"
        del self._constraints[joint]
        joint._leave()

    def _holds(self, each):
        return each in self._bodies or each in self._shapes or each in self._constraints

    def add_post_step_callback(self, callback, key, *args, **kwargs):
        if key in self._post_step:
            return False
        self._post_step[key] = (callback, args, kwargs)
        return True

    def step(self, dt):
        self.current_time_step = dt
        for body in self._bodies:
            if body._type != Body.DYNAMIC:
                continue
            body._require_mass()
        self._call_constraints("pre_solve")
        for joint in self._constraints:
            joint._ready(dt)
        self._pass_forces()
        self._move_belts()
        self._stepping = self._in_world = True
        self._steps += 1
        try:
            try:
                self._world.step(dt, self._substeps)
            finally:
                self._in_world = False
                later, self._later = self._later, []
                for action in later:
                    action()
            self._bounce_higher()
            if PLUMBS_SLEEP_TIME < self._sleep_time < math.inf:
                self._count_idle_time(dt)
            self._report()
            self._call_constraints("post_solve")
        finally:
            self._stepping = False
        self._do_waiting()
        later, self._post_step = self._post_step, {}
        for key, (callback, args, kwargs) in later.items():
            callback(self, key, *args, **kwargs)

    def _pass_forces(self):
        """Hands over the forces for this step; those set from here on, as by callbacks, are for the next one."""
        self._forces = {}
        for body in self._bodies:
            if body._type == Body.DYNAMIC:
                if body.force != (0, 0):
                    body._held.apply_force(body.force)
                    self._forces[body] = Vec2d(*body.force)
                if body.torque:
                    body._held.apply_torque(body.torque)
            body.force, body.torque = Vec2d(0, 0), 0.0

    def _count_idle_time(self, dt):
        """Keeps bodies awake until they have been slow for as long as the threshold says, where plumb's own is less."""
        limit = self._idle_speed**2 or self.gravity.length_squared * dt**2
        for body in self._bodies:
            if body._type == Body.DYNAMIC and body._held.awake:
                slow = body.kinetic_energy <= body.mass * limit
                body._idle = body._idle + dt if slow else 0.0
                body._let_sleep(body._idle >= self._sleep_time - PLUMBS_SLEEP_TIME)

    def _do_waiting(self):
        while self._waiting:
            waiting, self._waiting = self._waiting, []
            for call, objects in waiting:
                adds = call == self.add
                # Does once what was asked for several times within the step.
                call(*[each for each in objects if self._holds(each) != adds])

    def _call_constraints(self, name):
        for joint in list(self._constraints):
            if getattr(joint, name) is not None:
                getattr(joint, name)(joint, self)
