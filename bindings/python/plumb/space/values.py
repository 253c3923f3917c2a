"""Vectors, boxes, filters and what queries return."""

from __future__ import annotations

import math
import numbers
import weakref
from typing import Any, NamedTuple

from plumb._errors import InvalidValue

BIG = 1e9  # in any unit: as good as without a bound


class Refused(InvalidValue, AssertionError):
    """A value that cannot be; an AssertionError too, which is what pymunk raises."""


def refuse(subject, field, value, problem):
    error = Refused(f"{subject}: {field} is {value!r}: {problem}")
    error.subject, error.field, error.value, error.problem = subject, field, repr(value), problem
    raise error


def number(subject, field, value, least=-math.inf, most=math.inf, unbounded=False):
    """Returns a number from least to most as a float; infinite ones only if `unbounded`."""
    if not isinstance(value, numbers.Real):
        refuse(subject, field, value, "must be a number")
    given = float(value)
    if not least <= given <= most or (math.isinf(given) and not unbounded):
        bound = "" if least == -math.inf else f" of at least {least:g}" if most == math.inf else f" from {least:g} to {most:g}"
        refuse(subject, field, value, f"must be a {'' if unbounded else 'finite '}number{bound}")
    return given


def vector(subject, field, value):
    """Returns two finite numbers."""
    try:
        x, y = value
    except (TypeError, ValueError):
        refuse(subject, field, value, "must be two numbers, (x, y)")
    return Vec2d(number(subject, f"{field}'s x", x), number(subject, f"{field}'s y", y))


class InSpace:
    """Belongs to a space without keeping it alive: a space is gone with the last one who uses it."""

    _ref = None

    def __reduce_ex__(self, protocol):
        if self._space is not None:
            raise NotImplementedError(f"a {type(self).__name__} in a space cannot be copied or pickled in plumb")
        return super().__reduce_ex__(protocol)

    @property
    def _space(self):
        return self._ref and self._ref()

    @_space.setter
    def _space(self, space):
        self._ref = space and weakref.ref(space)


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
