"""A subset of pymunk's interface over plumb, for programs that come from there (docs/python.md).

Names and signatures are pymunk's, numbers are plumb's: `Space.step` runs plumb's solver in double precision. Angles in
rad; other units are the program's own, as long as they belong together. What has no counterpart raises
NotImplementedError when it is added to a space.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from plumb import _plumb

version = "0.1"
_BIG = 1e9


class Vec2d(NamedTuple):
    x: float
    y: float

    def __add__(self, other):
        return Vec2d(self.x + other[0], self.y + other[1])

    __radd__ = __add__

    def __sub__(self, other):
        return Vec2d(self.x - other[0], self.y - other[1])

    def __rsub__(self, other):
        return Vec2d(other[0] - self.x, other[1] - self.y)

    def __mul__(self, factor):
        return Vec2d(self.x * factor, self.y * factor)

    __rmul__ = __mul__

    def __truediv__(self, by):
        return Vec2d(self.x / by, self.y / by)

    def __neg__(self):
        return Vec2d(-self.x, -self.y)

    def __abs__(self):
        return self.length

    @property
    def length(self) -> float:
        return math.hypot(self.x, self.y)

    @property
    def length_squared(self) -> float:
        return self.x * self.x + self.y * self.y

    @property
    def angle(self) -> float:
        return math.atan2(self.y, self.x)

    @property
    def angle_degrees(self) -> float:
        return math.degrees(self.angle)

    def dot(self, other) -> float:
        return self.x * other[0] + self.y * other[1]

    def cross(self, other) -> float:
        return self.x * other[1] - self.y * other[0]

    def perpendicular(self) -> Vec2d:
        return Vec2d(-self.y, self.x)

    def rotated(self, angle: float) -> Vec2d:
        c, s = math.cos(angle), math.sin(angle)
        return Vec2d(c * self.x - s * self.y, s * self.x + c * self.y)

    def normalized(self) -> Vec2d:
        return self / self.length if self.length else Vec2d(0, 0)

    def get_distance(self, other) -> float:
        return (self - other).length

    def interpolate_to(self, other, fraction: float) -> Vec2d:
        return self + (Vec2d(*other) - self) * fraction

    @staticmethod
    def zero() -> Vec2d:
        return Vec2d(0, 0)

    @staticmethod
    def from_polar(length: float, angle: float) -> Vec2d:
        return Vec2d(length * math.cos(angle), length * math.sin(angle))


class BB(NamedTuple):
    """A box along the axes."""

    left: float = 0
    bottom: float = 0
    right: float = 0
    top: float = 0

    @staticmethod
    def newForCircle(centre, radius):
        return BB(centre[0] - radius, centre[1] - radius, centre[0] + radius, centre[1] + radius)

    def intersects(self, other):
        return (self.left <= other.right and other.left <= self.right and self.bottom <= other.top
                and other.bottom <= self.top)

    def contains(self, other):
        return (self.left <= other.left and self.right >= other.right and self.bottom <= other.bottom
                and self.top >= other.top)

    def contains_vect(self, v):
        return self.left <= v[0] <= self.right and self.bottom <= v[1] <= self.top

    def merge(self, other):
        return BB(min(self.left, other.left), min(self.bottom, other.bottom), max(self.right, other.right),
                  max(self.top, other.top))

    def expand(self, v):
        return self.merge(BB(v[0], v[1], v[0], v[1]))

    def center(self):
        return Vec2d((self.left + self.right) / 2, (self.bottom + self.top) / 2)

    def area(self):
        return (self.right - self.left) * (self.top - self.bottom)

    def merged_area(self, other):
        return self.merge(other).area()

    def segment_query(self, a, b):
        """Returns the fraction of the segment at which it enters, or infinity."""
        enter, leave = -math.inf, math.inf
        for start, way, low, high in ((a[0], b[0] - a[0], self.left, self.right),
                                      (a[1], b[1] - a[1], self.bottom, self.top)):
            if way == 0:
                if not low <= start <= high:
                    return math.inf
                continue
            ends = sorted(((low - start) / way, (high - start) / way))
            enter, leave = max(enter, ends[0]), min(leave, ends[1])
        return max(enter, 0) if enter <= leave and leave >= 0 and enter <= 1 else math.inf

    def intersects_segment(self, a, b):
        return self.segment_query(a, b) != math.inf

    def clamp_vect(self, v):
        return Vec2d(min(max(v[0], self.left), self.right), min(max(v[1], self.bottom), self.top))


class Transform(NamedTuple):
    """x' = a x + c y + tx, y' = b x + d y + ty."""

    a: float = 1
    b: float = 0
    c: float = 0
    d: float = 1
    tx: float = 0
    ty: float = 0

    @staticmethod
    def identity():
        return Transform()

    def __matmul__(self, v):
        return Vec2d(self.a * v[0] + self.c * v[1] + self.tx, self.b * v[0] + self.d * v[1] + self.ty)


class ShapeFilter(NamedTuple):
    group: int = 0
    categories: int = 0xFFFFFFFF
    mask: int = 0xFFFFFFFF

    @staticmethod
    def ALL_MASKS():
        return 0xFFFFFFFF

    @staticmethod
    def ALL_CATEGORIES():
        return 0xFFFFFFFF

    def rejects(self, other):
        return ((self.group != 0 and self.group == other.group) or not self.categories & other.mask
                or not other.categories & self.mask)


class ContactPoint(NamedTuple):
    point_a: Vec2d
    point_b: Vec2d
    distance: float


class ContactPointSet(NamedTuple):
    normal: Vec2d
    points: list


class PointQueryInfo(NamedTuple):
    shape: Any
    point: Vec2d
    distance: float
    gradient: Vec2d


class SegmentQueryInfo(NamedTuple):
    shape: Any
    point: Vec2d
    normal: Vec2d
    alpha: float


class ShapeQueryInfo(NamedTuple):
    shape: Any
    contact_point_set: ContactPointSet


# ---- Moments and areas ----------------------------------------------------------------------------------------------

def moment_for_circle(mass, inner_radius, outer_radius, offset=(0, 0)):
    return mass * (0.5 * (inner_radius**2 + outer_radius**2) + offset[0]**2 + offset[1]**2)


def moment_for_segment(mass, a, b, radius):
    """Returns the moment of a box as long as the segment with its rounded ends, about the origin."""
    middle = (Vec2d(*a) + b) / 2
    length = (Vec2d(*b) - a).length + 2 * radius
    return mass * ((length**2 + 4 * radius**2) / 12 + middle.length_squared)


def moment_for_poly(mass, vertices, offset=(0, 0), radius=0):
    above = below = 0.0
    points = [Vec2d(*v) + offset for v in vertices]
    if len(points) == 2:
        return moment_for_segment(mass, points[0], points[1], 0)
    for p, q in zip(points, points[1:] + points[:1]):
        area = q.cross(p)
        above += area * (p.dot(p) + p.dot(q) + q.dot(q))
        below += area
    return mass * above / (6 * below)


def moment_for_box(mass, size):
    return mass * (size[0]**2 + size[1]**2) / 12


def area_for_circle(inner_radius, outer_radius):
    return math.pi * abs(inner_radius**2 - outer_radius**2)


def area_for_segment(a, b, radius):
    return radius * (math.pi * radius + 2 * (Vec2d(*b) - a).length)


def area_for_poly(vertices, radius=0):
    points = [Vec2d(*v) for v in vertices]
    pairs = list(zip(points, points[1:] + points[:1]))
    area = sum(p.cross(q) for p, q in pairs) / 2
    round_about = sum((q - p).length for p, q in pairs)
    return radius * (math.pi * abs(radius) + round_about) + area


def _hull(points):
    """Returns the convex hull, counter-clockwise."""
    ordered = sorted(set(map(tuple, points)))
    if len(ordered) < 3:
        return [Vec2d(*p) for p in ordered]

    def half(side):
        out = []
        for p in side:
            while len(out) > 1 and (Vec2d(*out[-1]) - out[-2]).cross(Vec2d(*p) - out[-1]) <= 0:
                out.pop()
            out.append(p)
        return out[:-1]

    return [Vec2d(*p) for p in half(ordered) + half(ordered[::-1])]


# ---- Bodies ---------------------------------------------------------------------------------------------------------

class Body:
    DYNAMIC, KINEMATIC, STATIC = 0, 1, 2
    _TYPES = {DYNAMIC: "dynamic", KINEMATIC: "kinematic", STATIC: "static"}
    _names = {DYNAMIC: "DYNAMIC", KINEMATIC: "KINEMATIC", STATIC: "STATIC"}

    def __init__(self, mass: float = 0, moment: float = 0, body_type: int = DYNAMIC) -> None:
        self._held = None
        self._space = None
        self._type = body_type
        self._mass, self._moment = float(mass), float(moment)
        self._cog = Vec2d(0, 0)
        self._position, self._angle = Vec2d(0, 0), 0.0
        self._velocity, self._spin = Vec2d(0, 0), 0.0
        self.force, self._torque = Vec2d(0, 0), 0.0
        self._shapes: dict[Shape, None] = {}
        self._constraints: dict[Constraint, None] = {}

    def __repr__(self):
        if self._type != Body.DYNAMIC:
            return f"Body(Body.{self._names[self._type]})"
        return f"Body({self._mass}, {self._moment}, Body.DYNAMIC)"

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
        turns = moment < math.inf
        self._held.set_mass(mass, moment if turns else 1.0, cog)
        self._held.set_locks(rotation=not turns)

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
        if self._held:
            self._held.position = self._position

    @property
    def angle(self):
        return self._held.angle if self._held else self._angle

    @angle.setter
    def angle(self, angle):
        self._angle = float(angle)
        if self._held:
            self._held.angle = self._angle

    @property
    def velocity(self):
        return Vec2d(*self._held.velocity) if self._held else self._velocity

    @velocity.setter
    def velocity(self, velocity):
        assert len(velocity) == 2
        self._velocity = Vec2d(*velocity)
        if self._held and self._type != Body.STATIC:
            self._held.velocity = self._velocity

    @property
    def angular_velocity(self):
        return self._held.angular_velocity if self._held else self._spin

    @angular_velocity.setter
    def angular_velocity(self, spin):
        self._spin = float(spin)
        if self._held and self._type != Body.STATIC:
            self._held.angular_velocity = self._spin

    @property
    def torque(self):
        return self._torque

    @torque.setter
    def torque(self, torque):
        self._torque = float(torque)

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
        for joint in self._constraints:
            other = joint._b if joint._a is self else joint._a
            assert Body.DYNAMIC in (body_type, other._type), "At least one body of a constraint must be dynamic."
        self._type = body_type
        if self._held:
            self._held.type = self._TYPES[body_type]
            self._update_mass()

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
        if self._held and self._type == Body.DYNAMIC:
            self._held.awake = True

    def sleep(self):
        if self._held is None:
            raise Exception("Body not added to a space")
        self._held.awake = False

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
        self.activate()
        mass, moment, _ = self._mass_now()
        self.velocity = self.velocity + Vec2d(*impulse) / mass
        self.angular_velocity = self.angular_velocity + (Vec2d(*point) - self._centre()).cross(impulse) / moment

    def apply_impulse_at_local_point(self, impulse, point=(0, 0)):
        self.apply_impulse_at_world_point(Vec2d(*impulse).rotated(self.angle), self.local_to_world(point))

    def each_arbiter(self, function, *args, **kwargs):
        for contact in self._held.contacts() if self._held else ():
            function(self._space._arbiter_of(contact), *args, **kwargs)

    def _enter(self, space):
        self._space = space
        self._held = space._world.create_body(type=self._TYPES[self._type], position=self._position, angle=self._angle,
                                              velocity=self._velocity, angular_velocity=self._spin,
                                              mass=(1.0, 1.0, (0, 0)) if self._type == Body.DYNAMIC else None)
        self._held.linear_damping = self._held.angular_damping = space._rate()
        self._update_mass()

    def _leave(self):
        self._position, self._angle = self.position, self.angle
        self._velocity, self._spin = self.velocity, self.angular_velocity
        held, self._held, self._space = self._held, None, None
        held.destroy()


# ---- Shapes ---------------------------------------------------------------------------------------------------------

class Shape:
    def __init__(self, body):
        self._held = None
        self._space = None
        self._body = None
        self._friction = self._elasticity = 0.0
        self._surface = Vec2d(0, 0)
        self._filter = ShapeFilter()
        self._sensor = False
        self._weight = None  # ("mass", kg) or ("density", kg per area)
        self._collision_type = 0
        self._bb = BB()
        self.body = body

    @property
    def body(self):
        return self._body

    @body.setter
    def body(self, body):
        if self._body is not None:
            self._body._shapes.pop(self, None)
        self._body = body
        if body is not None:
            body._shapes[self] = None
            body._update_mass()

    @property
    def space(self):
        return self._space

    def _set(self, name, value):
        setattr(self, name, value)
        if self._held:
            self._leave_world()
            self._enter_world()

    friction = property(lambda self: self._friction, lambda self, value: self._set("_friction", value))
    elasticity = property(lambda self: self._elasticity, lambda self, value: self._set("_elasticity", value))
    collision_type = property(lambda self: self._collision_type, lambda self, v: self._set("_collision_type", v))
    sensor = property(lambda self: self._sensor, lambda self, value: self._set("_sensor", bool(value)))
    surface_velocity = property(lambda self: self._surface, lambda self, v: self._set("_surface", Vec2d(*v)))

    @property
    def filter(self):
        return self._filter

    @filter.setter
    def filter(self, value):
        self._filter = value
        if self._held:
            self._held.set_filter(value.categories, value.mask, -value.group)

    def _unit(self):
        """Returns area, moment about the centre of gravity of a unit mass, and that centre."""
        raise NotImplementedError

    @property
    def area(self):
        return self._unit()[0]

    @property
    def center_of_gravity(self):
        return self._unit()[2]

    @property
    def moment(self):
        return self.mass * self._unit()[1]

    @property
    def mass(self):
        if self._weight is None:
            return 0.0
        return self._weight[1] * (1 if self._weight[0] == "mass" else self.area)

    @mass.setter
    def mass(self, mass):
        self._weight = ("mass", float(mass))
        if self._body is not None:
            self._body._update_mass()

    @property
    def density(self):
        return self.mass / self.area if self.mass else 0.0

    @density.setter
    def density(self, density):
        self._weight = ("density", float(density))
        if self._body is not None:
            self._body._update_mass()

    def _geometry(self):
        raise NotImplementedError

    def _place(self):
        return Vec2d(0, 0)

    def _corners(self):
        """Returns the corners in the body's frame; `radius` rounds them."""
        raise NotImplementedError

    def _placed(self):
        place = self._body.local_to_world if self._body is not None else lambda v: Vec2d(*v)
        return [place(v) for v in self._corners()]

    def _box_of(self, points):
        r = self.radius
        return BB(min(p[0] for p in points) - r, min(p[1] for p in points) - r, max(p[0] for p in points) + r,
                  max(p[1] for p in points) + r)

    @property
    def bb(self):
        return self._box_of(self._placed()) if self._body is not None else self._bb

    def cache_bb(self):
        return self.bb

    def update(self, transform):
        self._bb = self._box_of([transform @ v for v in self._corners()])
        return self._bb

    def point_query(self, p):
        return _nearest(self, Vec2d(*p))

    def segment_query(self, start, end, radius=0):
        """Returns the hit of a segment, or None."""
        return _cast(self, Vec2d(*start), Vec2d(*end), radius)

    def _enter_world(self):
        f = self._filter
        self._held = self._body._held.create_shape(_plumb.ShapeDefinition(
            self._geometry(), position=self._place(), density=0, friction=self._friction, restitution=min(self._elasticity, 1.0),
            surface_speed=-self._surface.x, category=f.categories, mask=f.mask, group=-f.group, sensor=self._sensor,
            pre_solve=self._space._asks(self)))
        self._space._of[self._held.index] = self

    def _leave_world(self):
        del self._space._of[self._held.index]
        self._held.destroy()
        self._held = None


class Circle(Shape):
    def __init__(self, body, radius, offset=(0, 0)):
        self._radius, self._offset = radius, Vec2d(*offset)
        super().__init__(body)

    radius = property(lambda self: self._radius)
    offset = property(lambda self: self._offset)

    def unsafe_set_radius(self, radius):
        self._set("_radius", radius)

    def unsafe_set_offset(self, offset):
        self._set("_offset", Vec2d(*offset))

    def _unit(self):
        return math.pi * self._radius**2, self._radius**2 / 2, self._offset

    def _geometry(self):
        return _plumb.Circle(self._radius)

    def _place(self):
        return self._offset

    def _corners(self):
        return [self._offset]


class Segment(Shape):
    def __init__(self, body, a, b, radius):
        self._a, self._b, self._radius = Vec2d(*a), Vec2d(*b), radius
        super().__init__(body)

    a = property(lambda self: self._a)
    b = property(lambda self: self._b)
    radius = property(lambda self: self._radius)

    @property
    def normal(self):
        return -(self._b - self._a).normalized().perpendicular()

    def unsafe_set_endpoints(self, a, b):
        self._a = Vec2d(*a)
        self._set("_b", Vec2d(*b))

    def unsafe_set_radius(self, radius):
        self._set("_radius", radius)

    def set_neighbors(self, prev, next):
        """Does nothing: plumb smooths the seams of neighbouring segments by itself."""

    def _unit(self):
        middle = (self._a + self._b) / 2
        own = moment_for_segment(1, self._a - middle, self._b - middle, self._radius)
        return area_for_segment(self._a, self._b, self._radius), own, middle

    def _geometry(self):
        if self._radius > 0:
            return _plumb.Capsule(self._a, self._b, self._radius)
        return _plumb.Segment(self._a, self._b)

    def _corners(self):
        return [self._a, self._b]


class Poly(Shape):
    def __init__(self, body, vertices, transform=None, radius=0):
        self._radius = radius
        self._vertices = _hull([(transform or Transform()) @ v for v in vertices])
        super().__init__(body)

    radius = property(lambda self: self._radius)

    @staticmethod
    def create_box(body, size=(10, 10), radius=0):
        w, h = size[0] / 2, size[1] / 2
        return Poly.create_box_bb(body, BB(-w, -h, w, h), radius)

    @staticmethod
    def create_box_bb(body, bb, radius=0):
        poly = Poly(body, [(bb.right, bb.bottom), (bb.right, bb.top), (bb.left, bb.top), (bb.left, bb.bottom)], None,
                    radius)
        poly._vertices = poly._vertices[1:] + poly._vertices[:1]
        return poly

    def get_vertices(self):
        return list(self._vertices)

    def unsafe_set_radius(self, radius):
        self._set("_radius", radius)

    def unsafe_set_vertices(self, vertices, transform=None):
        self._set("_vertices", _hull([(transform or Transform()) @ v for v in vertices]))

    def _unit(self):
        points = self._vertices
        pairs = list(zip(points, points[1:] + points[:1]))
        twice = sum(p.cross(q) for p, q in pairs)
        middle = sum(((p + q) * p.cross(q) for p, q in pairs), Vec2d(0, 0)) / (3 * twice)
        return area_for_poly(points, self._radius), moment_for_poly(1, points, -middle), middle

    def _geometry(self):
        return _plumb.Polygon(self._vertices, self._radius)

    def _corners(self):
        return self._vertices


# ---- Queries of one shape -------------------------------------------------------------------------------------------

def _nearest(shape, p):
    """Returns the point of the surface nearest to p, its distance (negative inside) and the direction away from it."""
    points, r = shape._placed(), shape.radius
    inside = len(points) > 2
    best = None
    deepest, way = -math.inf, None
    for a, b in zip(points, points[1:] + points[:1]):
        along = b - a
        t = min(max((p - a).dot(along) / along.length_squared, 0), 1) if along.length_squared else 0
        at = a + along * t
        if best is None or (p - at).length < (p - best).length:
            best = at
        if inside:
            out = -along.perpendicular().normalized()
            height = (p - a).dot(out)
            inside = height <= 0
            if height > deepest:
                deepest, way = height, out
    if inside:
        return PointQueryInfo(shape, p + way * (r - deepest), deepest - r, way)
    gap = (p - best).length
    away = (p - best) / gap if gap else Vec2d(0, 1)
    return PointQueryInfo(shape, best + away * r, gap - r, away)


def _cast(shape, start, end, radius):
    """Returns the hit of a disc of `radius` that moves from start to end: the first time at which it is that near."""
    length = (end - start).length
    travelled = 0.0
    for _ in range(64):  # conservative advancement: the distance is always safe to go
        near = _nearest(shape, start + (end - start) * (travelled / length if length else 0))
        gap = near.distance - radius
        if gap <= 1e-9 * (1 + length):
            alpha = travelled / length if length else 0.0
            return SegmentQueryInfo(shape, near.point, near.gradient, alpha)
        travelled += gap
        if travelled > length:
            return None
    return SegmentQueryInfo(shape, near.point, near.gradient, travelled / length)


# ---- Constraints ----------------------------------------------------------------------------------------------------

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
        return _plumb.Motor(target_angle=-self._rest, max_torque=_BIG,
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


# ---- Collisions -----------------------------------------------------------------------------------------------------

class Arbiter:
    """Two shapes that touch, as callbacks see them."""

    def __init__(self, space, shapes, contact=None, first=False, removal=False):
        self._space = space
        self._shapes = shapes
        self._contact = contact
        self.is_first_contact = first
        self.is_removal = removal
        self.process_collision = True
        self.restitution = shapes[0].elasticity * shapes[1].elasticity
        self.friction = shapes[0].friction * shapes[1].friction

    @property
    def shapes(self):
        return self._shapes

    @property
    def bodies(self):
        return self._shapes[0].body, self._shapes[1].body

    @property
    def normal(self):
        return self.contact_point_set.normal

    @property
    def contact_point_set(self):
        c = self._contact
        if c is None:
            return ContactPointSet(Vec2d(0, 0), [])
        # Points lie half-way between the surfaces; overlap is negative.
        turned = self._space._of.get(c["shape_a"].index) is not self._shapes[0]
        normal = Vec2d(*c["normal"]) * (-1 if turned else 1)
        points = []
        for at, gap in zip(c["points"], c["separations"]):
            half = normal * (gap / 2)
            points.append(ContactPoint(Vec2d(*at) - half, Vec2d(*at) + half, gap))
        return ContactPointSet(normal, points)

    @property
    def total_impulse(self):
        c = self._contact
        return self.normal * c["step_impulse"] if c and "step_impulse" in c else Vec2d(0, 0)


class _Handler(NamedTuple):
    types: tuple
    begin: Any
    pre_solve: Any
    post_solve: Any
    separate: Any
    data: Any


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
        self._handlers: dict[tuple, _Handler] = {}
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
        return max(-math.log(self._damping), 0.0) if self._damping > 0 else _BIG

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
        self._handlers[types] = _Handler(types, begin, pre_solve, post_solve, separate, data)
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
        near = [_nearest(s, Vec2d(*point)) for s in self._seen(shape_filter)]
        return [hit for hit in near if hit.distance <= max_distance]

    def point_query_nearest(self, point, max_distance, shape_filter):
        return min(self.point_query(point, max_distance, shape_filter), key=lambda hit: hit.distance, default=None)

    def segment_query(self, start, end, radius, shape_filter):
        casts = (_cast(s, Vec2d(*start), Vec2d(*end), radius) for s in self._seen(shape_filter))
        return [hit for hit in casts if hit is not None]

    def segment_query_first(self, start, end, radius, shape_filter):
        return min(self.segment_query(start, end, radius, shape_filter), key=lambda hit: hit.alpha, default=None)

    def bb_query(self, bb, shape_filter):
        return [s for s in self._seen(shape_filter) if s.bb.intersects(bb)]

    def shape_query(self, shape):
        hits = []
        for other in self._seen(shape.filter):
            points = _touch(shape, other)
            if points is not None:
                hits.append(ShapeQueryInfo(other, points))
        return hits


def _touch(a, b):
    """Returns the contact of two shapes by the deepest of their corners in each other, or None if they are apart."""
    best = None
    for one, other, sign in ((a, b, -1), (b, a, 1)):
        for corner in one._placed():
            near = _nearest(other, corner)
            gap = near.distance - one.radius
            if gap <= 0 and (best is None or gap < best[0]):
                edge = corner - near.gradient * one.radius
                pair = (edge, near.point) if one is a else (near.point, edge)
                best = gap, near.gradient * sign, pair
    if best is None:
        return None
    return ContactPointSet(best[1], [ContactPoint(best[2][0], best[2][1], best[0])])


def _shapes_collide(self, other):
    return _touch(self, other) or ContactPointSet(Vec2d(0, 0), [])


Shape.shapes_collide = _shapes_collide
