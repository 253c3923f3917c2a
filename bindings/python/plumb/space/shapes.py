"""Shapes of bodies: Circle, Segment, Poly."""

import math

from plumb import _plumb
from plumb.space.geometry import cast, nearest, touch
from plumb.space.moments import area_for_poly, area_for_segment, hull_of, moment_for_poly, moment_for_segment
from plumb.space.values import BB, ContactPointSet, InSpace, ShapeFilter, Transform, Vec2d


class Shape(InSpace):
    _rank = 0  # of its kind in a pair
    _age = 0  # in the order in which shapes came to the space

    def __init__(self, body):
        self._held = None
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

    def _do(self, action):
        """Acts on the world's shape if there is one: at the end of the step for callbacks from within one."""
        if self._held and self._space is not None:
            self._space._do(lambda: action() if self._held else None)

    def _set_geometry(self, name, value):
        setattr(self, name, value)
        self._do(self._renew)

    def _renew(self):
        self._leave_world()
        self._enter_world()
        self._space._note_new_geometry(self)

    def _quality(name, pass_on):
        def put(self, value):
            setattr(self, name, value)
            self._do(lambda: pass_on(self))

        return property(lambda self: getattr(self, name), put)

    friction = _quality("_friction", lambda self: setattr(self._held, "friction", self._friction))
    elasticity = _quality("_elasticity", lambda self: self._pass_elasticity())
    collision_type = _quality("_collision_type", lambda self: self._tell_callbacks())
    sensor = _quality("_sensor", lambda self: setattr(self._held, "sensor", bool(self._sensor)))
    del _quality

    def _pass_elasticity(self):
        self._held.restitution = min(self._elasticity, 1.0)
        self._tell_callbacks()

    def _tell_callbacks(self):
        """Lets the world ask before it resolves contacts, and tell the impulses of impacts within the step."""
        asks = self._space._asks(self)
        self._held.pre_solve, self._held.hit_events = asks, asks or self._elasticity > 1

    @property
    def surface_velocity(self):
        return self._surface

    @surface_velocity.setter
    def surface_velocity(self, velocity):
        self._surface = Vec2d(*velocity)
        if self._space is not None:
            self._space._note_belt(self)

    def _facing(self, up):
        """Returns the direction of the side that a body is likely to land on, before any does."""
        return up.normalized() if up != (0, 0) else Vec2d(0, 1)

    def _move_surface(self, speed):
        if self._held.surface_speed != speed:
            self._held.surface_speed = speed

    @property
    def filter(self):
        return self._filter

    @filter.setter
    def filter(self, value):
        self._filter = value
        self._do(lambda: self._held.set_filter(value.categories, value.mask, -value.group))

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
        return nearest(self, Vec2d(*p))

    def segment_query(self, start, end, radius=0):
        """Returns the hit of a segment, or None."""
        return cast(self, Vec2d(*start), Vec2d(*end), radius)

    def shapes_collide(self, other):
        return touch(self, other) or ContactPointSet(Vec2d(0, 0), [])

    def _enter_world(self):
        f = self._filter
        self._held = self._body._held.create_shape(_plumb.ShapeDefinition(
            self._geometry(), position=self._place(), density=0, friction=self._friction,
            restitution=min(self._elasticity, 1.0),
            category=f.categories, mask=f.mask, group=-f.group, sensor=bool(self._sensor),
            pre_solve=self._space._asks(self), hit_events=self._elasticity > 1 or self._space._asks(self)))
        self._space._of[self._held.index] = self
        self._space._note_belt(self)

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
        self._set_geometry("_radius", radius)

    def unsafe_set_offset(self, offset):
        self._set_geometry("_offset", Vec2d(*offset))

    def _unit(self):
        return math.pi * self._radius**2, self._radius**2 / 2, self._offset

    def _geometry(self):
        return _plumb.Circle(self._radius)

    def _place(self):
        return self._offset

    def _corners(self):
        return [self._offset]


class Segment(Shape):
    _rank = 1

    def __init__(self, body, a, b, radius):
        self._a, self._b, self._radius = Vec2d(*a), Vec2d(*b), radius
        super().__init__(body)

    a = property(lambda self: self._a)
    b = property(lambda self: self._b)
    radius = property(lambda self: self._radius)

    @property
    def normal(self):
        return -(self._b - self._a).normalized().perpendicular()

    def _facing(self, up):
        side = self.normal.rotated(self._body.angle)
        return side if side.dot(up) >= 0 else -side

    def unsafe_set_endpoints(self, a, b):
        self._a = Vec2d(*a)
        self._set_geometry("_b", Vec2d(*b))

    def unsafe_set_radius(self, radius):
        self._set_geometry("_radius", radius)

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
    _rank = 2

    def __init__(self, body, vertices, transform=None, radius=0):
        self._radius = radius
        self._vertices = hull_of([(transform or Transform()) @ v for v in vertices])
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
        self._set_geometry("_radius", radius)

    def unsafe_set_vertices(self, vertices, transform=None):
        self._set_geometry("_vertices", hull_of([(transform or Transform()) @ v for v in vertices]))

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
