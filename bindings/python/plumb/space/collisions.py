"""Collisions of a space: its handlers, and the pairs of shapes that touch."""

import weakref

from plumb.space.arbiter import Arbiter, Handler
from plumb.space.bodies import Body
from plumb.space.geometry import touch
from plumb.space.values import Vec2d


def empty_callback(*_):
    """Stands for no callback."""


class Pair:
    """State of two shapes that touch. Lasts from begin to separate, as an arbiter's does in pymunk."""

    __slots__ = ("process", "step", "held", "sensor")

    def __init__(self):
        self.process = True  # what the last callback left
        self.step = -1  # in which the world asked for it
        self.held = False  # the world lets them touch
        self.sensor = False


def _order(shape):
    return shape._rank, -shape._age


class Collisions:
    """The part of a space that calls handlers.

    plumb asks before a contact acts, from within its step, and says afterwards which shapes touched. A pair begins
    when its contact is about to act, and is over when the world neither lets it touch nor asks for it.
    """

    def _start_collisions(self):
        self._handlers: dict[tuple, Handler] = {}
        self._touching: dict[tuple, Pair] = {}
        self._steps = 0
        self._in_world = False
        self._later: list = []  # changes from within the world's step
        self._belts: dict = {}  # shapes with a surface velocity
        own = weakref.ref(self)  # the world must not keep the space alive

        def ask(contact):
            space = own()
            return True if space is None else space._ask(contact)

        self._world.on_pre_solve(ask)

    def _do(self, action):
        """Changes the world: at once, or after its step if that is running."""
        if self._in_world:
            self._later.append(action)
        else:
            action()

    def on_collision(self, collision_type_a=None, collision_type_b=None, begin=None, pre_solve=None, post_solve=None,
                     separate=None, data=None):
        """Sets what is called for shapes of these collision types; None stands for any.

        What is not given stays as it was set before for these types; `empty_callback` unsets it.
        """
        types = collision_type_a, collision_type_b
        assert collision_type_a is not None or collision_type_b is None, "Give the collision type first, then None."
        given = begin, pre_solve, post_solve, separate
        before = self._handlers.get(types, Handler(types, None, None, None, None, {}))
        new = [None if after is empty_callback else after or old for after, old in zip(given, before[1:5])]
        names = ("begin", "pre_solve", "post_solve", "separate")
        told = {**before.data, **{name: data for name, function in zip(names, given) if function}}
        self._handlers[types] = Handler(types, *new, told)
        for shape in self._shapes:
            if shape._held and self._asks(shape):
                shape._do(lambda shape=shape: shape._tell_callbacks())

    def _asks(self, shape):
        return any(shape.collision_type in types or None in types for types in self._handlers)

    def _handlers_of(self, a, b):
        """Returns the handlers of two shapes, the most specific first, each with the shapes in its order."""
        found = []
        for types in self._handlers:
            for pair in ((a, b), (b, a)):
                if all(t is None or t == s.collision_type for t, s in zip(types, pair)):
                    found.append((types, pair))
                    if types[0] == types[1] or None not in types:
                        break  # (type, None) sees a pair of its type from both sides
        for types, pair in sorted(found, key=lambda each: each[0].count(None)):
            yield self._handlers[types], pair

    def _pair_of(self, one, other):
        """Returns two of the world's shapes as a key of `_touching`, or None if one is gone."""
        a, b = self._of.get(one.index), self._of.get(other.index)
        if a is None or b is None or a._held != one or b._held != other:
            return None
        return (a, b) if _order(a) <= _order(b) else (b, a)

    def _arbiter_of(self, contact, body):
        pair = self._pair_of(contact["shape_a"], contact["shape_b"])
        state = self._touching.get(pair)
        if pair[0].body is not body:
            pair = pair[::-1]
        return Arbiter(self, pair, contact, process=state is None or state.process)

    def _call(self, name, pair, state, contact=None, first=False, removal=False):
        for handler, shapes in self._handlers_of(*pair):
            function = getattr(handler, name)
            if function is not None:
                seen = contact
                if not isinstance(contact, dict) and contact is not None and shapes != pair:
                    seen = touch(*shapes)
                arbiter = Arbiter(self, shapes, seen, first, removal, state.process)
                function(arbiter, self, handler.data.get(name))
                state.process = bool(arbiter.process_collision)

    # Within the world's step.
    def _acts(self, pair, contact):
        """Says if the surfaces meet within this step, by the velocities and accelerations that they have now."""
        gap = min(contact["separations"], default=1.0)
        if gap <= 0:
            return True
        a, b = contact["shape_a"].body, contact["shape_b"].body
        normal, dt = Vec2d(*contact["normal"]), self.current_time_step
        fall = 0.0
        for body, sign in ((self._of[contact["shape_a"].index].body, -1), (self._of[contact["shape_b"].index].body, 1)):
            if body._type == Body.DYNAMIC:
                force = self._forces.get(body)
                pull = self.gravity + (force / body.mass if force else Vec2d(0, 0))
                fall += sign * pull.dot(normal)
        # Substeps move a body by up to a dt^2, but no less than a dt^2 / 2.
        fall *= dt * (1 if fall < 0 else 0.5)
        for point, apart in zip(contact["points"], contact["separations"]):
            closing = (Vec2d(*b.velocity_at(point)) - a.velocity_at(point)).dot(normal)
            # An impact at the very end of the step is one of it: the world's velocities are single numbers.
            if apart + (closing + fall) * dt <= 1e-5 * abs(closing) * dt:
                return True
        return False

    def _ask(self, contact):
        pair = self._pair_of(contact["shape_a"], contact["shape_b"])
        if pair is None:
            return True
        state = self._touching.get(pair)
        if not (state is not None and state.held) and not self._acts(pair, contact):
            return state is None or state.process
        first = state is None
        if first:
            state = self._touching[pair] = Pair()
            self._call("begin", pair, state, contact, True)
        state.step = self._steps
        self._call("pre_solve", pair, state, contact, first)
        return state.process

    # After it.
    def _contact_of(self, pair, contacts):
        """Returns the contact of a pair as the world has it, or else from the shapes."""
        return contacts.get(pair) or touch(*pair)

    def _contacts(self):
        contacts = {}
        for body in self._bodies:
            for contact in body._held.contacts():
                contacts.setdefault(self._pair_of(contact["shape_a"], contact["shape_b"]), contact)
        return contacts

    def _impacts(self, contacts):
        """Returns the impacts within the step whose contacts no longer have an impulse, as contacts, by pair."""
        impacts = {}
        for hit in self._world.events["hits"]:
            pair = self._pair_of(hit["shape_a"], hit["shape_b"])
            if pair is not None and not contacts.get(pair, {"step_impulse": 0})["step_impulse"] > 0:
                impacts[pair] = {"shape_a": hit["shape_a"], "shape_b": hit["shape_b"], "normal": hit["normal"],
                                 "points": [hit["point"]], "separations": [0.0], "step_impulse": hit["impulse"]}
        return impacts

    def _report(self):
        events = self._world.events
        calls = any(any(handler[1:5]) for handler in self._handlers.values())
        contacts = self._contacts() if calls else {}
        for name in ("begin", "sensor_begin"):
            for one, other in events[name]:
                pair = self._pair_of(one, other)
                if pair is None:
                    continue
                state = self._touching.get(pair)
                if state is None:
                    # Met by what happened within the step: the contact has acted already.
                    state = self._touching[pair] = Pair()
                    contact = self._contact_of(pair, contacts)
                    self._call("begin", pair, state, contact, True)
                    if name == "begin":
                        self._call("pre_solve", pair, state, contact, True)
                state.held, state.sensor = True, name != "begin"
        for pair, contact in {**contacts, **self._impacts(contacts)}.items():
            state = self._touching.get(pair)
            if state is not None and contact["step_impulse"] > 0:
                self._call("post_solve", pair, state, contact)
        for pair, state in list(self._touching.items()):
            if state.sensor and state.held and any(h.pre_solve for h in self._handlers.values()):
                self._call("pre_solve", pair, state, touch(*pair))
        for name in ("end", "sensor_end"):
            for one, other in events[name]:
                state = self._touching.get(self._pair_of(one, other))
                if state is not None and state.sensor == (name == "sensor_end"):
                    state.held = False
        for pair, state in list(self._touching.items()):
            if not state.held and state.step != self._steps and not self._rests(pair):
                self._end(pair)

    @staticmethod
    def _rests(pair):
        """Says if both shapes sleep, so that the world does not ask for them."""
        bodies = [shape.body for shape in pair if shape.body._type == Body.DYNAMIC]
        return bool(bodies) and all(body.is_sleeping for body in bodies) and touch(*pair) is not None

    def _end(self, pair, removal=False):
        state = self._touching.pop(pair)
        self._call("separate", pair, state, removal=removal)

    def _bounce_higher(self):
        """Adds what impacts lack whose product of elasticities is above what plumb multiplied: it bounds each to 1."""
        for hit in self._world.events["hits"]:
            a, b = self._of.get(hit["shape_a"].index), self._of.get(hit["shape_b"].index)
            if a is None or b is None:
                continue
            used = min(a.elasticity, 1.0) * min(b.elasticity, 1.0)
            push = Vec2d(*hit["normal"]) * (hit["impulse"] * (a.elasticity * b.elasticity - used) / (1 + used))
            for shape, sign in ((a, -1), (b, 1)):
                if shape.body._type == Body.DYNAMIC:
                    shape.body._held.apply_impulse(push * sign, hit["point"])

    # Surfaces that move.
    def _note_new_geometry(self, shape):
        for pair, state in self._touching.items():
            if shape in pair:
                state.held = False  # until the world says so of the new one

    def _note_belt(self, shape):
        if shape._surface != (0, 0):
            self._belts[shape] = None
        elif self._belts.pop(shape, 0) is None and shape._held:
            self._do(lambda: shape._move_surface(0.0) if shape._held else None)

    def _move_belts(self):
        """Sets the speeds of surfaces along the sides on which they touch.

        plumb gives a shape one speed, to the right of someone who stands on it; pymunk a velocity in the world. A
        shape that touches on several sides has the speed of the one with the greatest impulse.
        """
        for shape in self._belts:
            if not shape._held:
                continue
            best, out = None, None
            for contact in shape._body._held.contacts():
                first = contact["shape_a"] == shape._held
                if first or contact["shape_b"] == shape._held:
                    weight = sum(contact["impulses"]), -min(contact["separations"])
                    if best is None or weight > best:
                        best, out = weight, Vec2d(*contact["normal"]) * (1 if first else -1)
            if out is None:
                out = shape._facing(-self.gravity)
            shape._move_surface(shape._surface.dot(-out.perpendicular()))
