"""Space: the bodies, shapes and constraints of a world of plumb, its callbacks and queries."""

from __future__ import annotations

import math

from plumb import _plumb
from plumb.space.arbiter import Arbiter, Handler
from plumb.space.bodies import Body
from plumb.space.constraints import Constraint
from plumb.space.geometry import cast, nearest, touch
from plumb.space.shapes import Shape
from plumb.space.values import BIG, ShapeQueryInfo, Vec2d


class Space:
    def __init__(self, threaded: bool = False) -> None:
        # Chipmunk multiplies both coefficients.
        self._world = _plumb.World(gravity=(0, 0), precision="double", sleeping=False, combine_friction="product",
                                   combine_restitution="product")
        self._threaded = threaded
        self._of: dict[int, Shape] = {}  # by the index of plumb's shape
        self._bodies: dict[Body, None] = {}
        self._shapes: dict[Shape, None] = {}
        self._constraints: dict[Constraint, None] = {}
        self._handlers: dict[tuple, Handler] = {}
        self._touching: set = set()
        self._waiting: list = []  # additions and removals from within a step
        self._post_step: dict = {}
        self._stepping = False
        self._damping, self._sleep_time = 1.0, math.inf
        self.iterations = 10
        self.idle_speed_threshold = 0.0
        self.collision_slop = 0.1
        self.collision_bias = (1 - 0.1)**60
        self.collision_persistence = 3
        self.current_time_step = 0.0
        self._static_body = Body(body_type=Body.STATIC)
        self._static_body._enter(self)
        self._world.on_pre_solve(self._ask)

    static_body = property(lambda self: self._static_body)
    bodies = property(lambda self: list(self._bodies))
    shapes = property(lambda self: list(self._shapes))
    constraints = property(lambda self: list(self._constraints))

    @property
    def gravity(self):
        return Vec2d(*self._world.gravity)

    @gravity.setter
    def gravity(self, gravity):
        assert len(gravity) == 2
        self._world.gravity = gravity

    @property
    def damping(self):
        """The share of a velocity that is left after a second."""
        return self._damping

    @damping.setter
    def damping(self, damping):
        self._damping = damping
        for body in self._bodies:
            body._held.linear_damping = body._held.angular_damping = self._rate()

    def _rate(self):
        return max(-math.log(self._damping), 0.0) if self._damping > 0 else BIG

    @property
    def sleep_time_threshold(self):
        return self._sleep_time

    @sleep_time_threshold.setter
    def sleep_time_threshold(self, seconds):
        self._sleep_time = seconds
        self._world.set_sleeping(seconds < math.inf)

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
        for kind, put in ((Body, self._add_body), (Shape, self._add_shape), (Constraint, self._add_constraint)):
            for each in objects:
                if isinstance(each, kind):
                    put(each)

    def _add_body(self, body):
        assert body not in self._bodies, "Body already added to this space."
        assert body._space is None, "Body already added to another space."
        self._bodies[body] = None
        body._enter(self)
        for joint in body._constraints:
            if joint in self._constraints and joint._held is None:
                joint._enter(self)

    def _add_shape(self, shape):
        assert shape._space is not self, "Shape already added to this space."
        assert shape._space is None, "Shape already added to another space."
        assert shape._body is not None, "The shape's body is not set."
        assert shape._body._space is self, "The shape's body must be added to the space before (or with) the shape."
        self._shapes[shape] = None
        shape._space = self
        shape._enter_world()
        shape._body._update_mass()

    def _add_constraint(self, joint):
        assert joint not in self._constraints, "Constraint already added to this space."
        self._constraints[joint] = None
        joint._enter(self)

    def remove(self, *objects):
        if self._stepping:
            self._waiting.append((self.remove, objects))
            return
        for kind, take in ((Constraint, self._remove_constraint), (Shape, self._remove_shape),
                           (Body, self._remove_body)):
            for each in objects:
                if isinstance(each, kind):
                    take(each)

    def _remove_body(self, body):
        assert body in self._bodies, "body not in space, already removed?"
        for joint in body._constraints:
            if joint._held is not None:
                joint._held = None  # destroyed with the body
        for shape in [s for s in body._shapes if s._held]:
            del self._of[shape._held.index]
            shape._held = None  # likewise
        del self._bodies[body]
        body._leave()

    def _remove_shape(self, shape):
        assert shape in self._shapes, "shape not in space, already removed?"
        del self._shapes[shape]
        shape._space = None
        if shape._held:
            del self._of[shape._held.index]
            if shape._held.valid:
                shape._held.destroy()
            shape._held = None
        for pair in [pair for pair in self._touching if shape in pair]:
            if pair in self._touching:
                self._end(pair, True)

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

    # Collisions.
    def on_collision(self, collision_type_a=None, collision_type_b=None, begin=None, pre_solve=None, post_solve=None,
                     separate=None, data=None):
        """Sets what is called for shapes of these collision types; None stands for any. Replaces what was set before."""
        types = collision_type_a, collision_type_b
        assert collision_type_a is not None or collision_type_b is None, "Give the collision type first, then None."
        self._handlers[types] = Handler(types, begin, pre_solve, post_solve, separate, data)
        for shape in self._shapes:
            if self._asks(shape) and not shape._held.pre_solve:
                shape._held.pre_solve = True

    def _asks(self, shape):
        return any(h.types == (None, None) or shape.collision_type in h.types or None in h.types
                   for h in self._handlers.values())

    def _handlers_of(self, a, b):
        """Returns the handlers of two shapes, each with the shapes in its order."""
        for h in list(self._handlers.values()):
            for pair in ((a, b), (b, a)):
                if all(t is None or t == s.collision_type for t, s in zip(h.types, pair)):
                    yield h, pair
                    break

    def _arbiter_of(self, contact, pair=None, first=False):
        if pair is None:
            pair = self._of[contact["shape_a"].index], self._of[contact["shape_b"].index]
        return Arbiter(self, pair, contact, first)

    def _call(self, name, pair, contact=None, first=False, removal=False):
        process = True
        for handler, shapes in self._handlers_of(*pair):
            function = getattr(handler, name)
            if function is not None:
                arbiter = Arbiter(self, shapes, contact, first, removal)
                function(arbiter, self, handler.data)
                process = process and arbiter.process_collision
        return process

    def _ask(self, contact):
        pair = self._of[contact["shape_a"].index], self._of[contact["shape_b"].index]
        if min(contact["separations"], default=1) > 0:
            return True  # they may meet within the step, and do not touch yet
        process = True
        first = pair not in self._touching
        if first:
            self._touching.add(pair)
            process = self._call("begin", pair, contact, True)
        return self._call("pre_solve", pair, contact, first) and process

    def _end(self, pair, removal=False):
        self._touching.discard(pair)
        self._call("separate", pair, removal=removal)

    def _report(self):
        events = self._world.events
        known = self._of
        for name in ("begin", "sensor_begin"):
            for a, b in events[name]:
                pair = known.get(a.index), known.get(b.index)
                if None not in pair and pair not in self._touching and pair[::-1] not in self._touching:
                    self._touching.add(pair)
                    self._call("begin", pair, first=True)
        if any(h.post_solve for h in self._handlers.values()):
            for body in self._bodies:
                for contact in body._held.contacts():
                    pair = known[contact["shape_a"].index], known[contact["shape_b"].index]
                    if pair in self._touching and body is pair[0].body or pair[0].body not in self._bodies:
                        self._call("post_solve", pair, contact)
        for name in ("end", "sensor_end"):
            for a, b in events[name]:
                pair = known.get(a.index), known.get(b.index)
                for each in (pair, pair[::-1]):
                    if each in self._touching:
                        self._end(each)

    def step(self, dt):
        for body in self._bodies:
            if body._type != Body.DYNAMIC:
                continue
            mass, moment, _ = body._mass_now()
            assert 0 < mass < math.inf, "Dynamic bodies must have a mass > 0, given or by their shapes."
            assert moment > 0, "Dynamic bodies must have a moment > 0, given or by their shapes."
            if body.force != (0, 0):
                body._held.apply_force(body.force)
            if body.torque:
                body._held.apply_torque(body.torque)
        self._call_constraints("pre_solve")
        self.current_time_step = dt
        self._stepping = True
        try:
            self._world.step(dt)
            self._report()
            self._call_constraints("post_solve")
        finally:
            self._stepping = False
        for body in self._bodies:
            body.force, body.torque = Vec2d(0, 0), 0.0
        waiting, self._waiting = self._waiting, []
        for call, objects in waiting:
            adds = call == self.add
            # Does once what was asked for several times within the step.
            call(*[each for each in objects if self._holds(each) != adds])
        later, self._post_step = self._post_step, {}
        for key, (callback, args, kwargs) in later.items():
            callback(self, key, *args, **kwargs)

    def _call_constraints(self, name):
        for joint in list(self._constraints):
            if getattr(joint, name) is not None:
                getattr(joint, name)(joint, self)

    # Queries: sensors are found, as in pymunk 7.
    def _seen(self, shape_filter):
        return [s for s in self._shapes if not s.filter.rejects(shape_filter)]

    def point_query(self, point, max_distance, shape_filter):
        near = [nearest(s, Vec2d(*point)) for s in self._seen(shape_filter)]
        return [hit for hit in near if hit.distance <= max_distance]

    def point_query_nearest(self, point, max_distance, shape_filter):
        return min(self.point_query(point, max_distance, shape_filter), key=lambda hit: hit.distance, default=None)

    def segment_query(self, start, end, radius, shape_filter):
        casts = (cast(s, Vec2d(*start), Vec2d(*end), radius) for s in self._seen(shape_filter))
        return [hit for hit in casts if hit is not None]

    def segment_query_first(self, start, end, radius, shape_filter):
        return min(self.segment_query(start, end, radius, shape_filter), key=lambda hit: hit.alpha, default=None)

    def bb_query(self, bb, shape_filter):
        return [s for s in self._seen(shape_filter) if s.bb.intersects(bb)]

    def shape_query(self, shape):
        hits = []
        for other in self._seen(shape.filter):
            points = touch(shape, other)
            if points is not None:
                hits.append(ShapeQueryInfo(other, points))
        return hits
