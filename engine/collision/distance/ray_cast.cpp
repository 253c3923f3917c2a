#include "engine/collision/distance/ray_cast.h"

#include <cmath>
#include <limits>

namespace plumb {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

template <class Real>
Vec2d corner(const Convex<Real>& shape, int i) {
  return shape.corners[i < shape.count ? i : 0].point.template as<double>();
}

/// Rotates e by a quarter turn clockwise: outward for an edge of a counter-clockwise polygon.
constexpr Vec2d outward(Vec2d e) { return {e.y, -e.x}; }

/// Returns the outward normal of an edge, at any length. From far away the corners of a short edge differ by
/// little more than their rounding, and a wrong direction would cut the shape: the stored normal is then the
/// better one. At 1e-9 of the distance either errs by 1e-7 rad, in float and in double.
template <class Real>
Vec2d edge_normal(const Convex<Real>& shape, int i, Vec2d p) {
  constexpr double kShort = 1e-9;
  const Vec2d e = corner(shape, i + 1) - p;
  const bool is_short = !(length_squared(e) > kShort * kShort * length_squared(p));
  return is_short ? shape.corners[i].normal.template as<double>() : outward(e);
}

/// Normalises `v`; returns up for a zero vector.
Vec2d direction_of(Vec2d v) {
  const double length = std::sqrt(length_squared(v));
  return length > 0 ? Vec2d{v.x / length, v.y / length} : Vec2d{0, 1};
}

/// The nearest point on the hull's edges; its distance is negative inside the hull.
struct Nearest {
  Vec2d point, normal;
  double distance = kInfinity;  ///< from the hull, negative inside
};

/// Returns the distance of the hull from a point outside it: that of the nearest edge.
template <class Real>
Nearest nearest_from_outside(const Convex<Real>& shape, Vec2d x) {
  Nearest best;
  double least = kInfinity;
  const int edges = shape.count < 3 ? 1 : shape.count;
  for (int i = 0; i < edges; ++i) {
    const Vec2d p = corner(shape, i), e = corner(shape, i + 1) - p, from_p = x - p;
    const double along = dot(from_p, e), size = length_squared(e);
    Vec2d at = p, normal = from_p;
    if (along >= size && along > 0) {
      at = p + e, normal = x - at;
    } else if (along > 0) {
      const double height = dot(from_p, outward(e)) / size;
      normal = height * outward(e);
      at = p + (along / size) * e;
    }
    const double square = length_squared(normal);
    if (square < least) {
      least = square;
      // On the line of an edge the difference is zero and has no direction: use the edge's.
      best = {at, square > 0 ? direction_of(normal) : direction_of(outward(e)), std::sqrt(square)};
    }
  }
  return best;
}

template <class Real>
Nearest nearest_on_hull(const Convex<Real>& shape, Vec2d x) {
  if (shape.count < 3) return nearest_from_outside(shape, x);
  Nearest best{{}, {}, -kInfinity};
  for (int i = 0; i < shape.count; ++i) {
    const Vec2d p = corner(shape, i), normal = direction_of(edge_normal(shape, i, p));
    const double height = dot(normal, x - p);
    if (height > best.distance) best = {x - height * normal, normal, height};
  }
  return best.distance <= 0 ? best : nearest_from_outside(shape, x);
}

/// A hit before it is rounded.
struct Entry {
  double fraction = kInfinity;
  Vec2d normal;
};

/// Returns where the ray enters the disc of `radius` around `center`, if it starts outside.
Entry enter_disc(Vec2d center, double radius, Vec2d origin, Vec2d direction) {
  const Vec2d from = origin - center;
  const double size = length_squared(direction), along = -dot(from, direction),
               across = cross(direction, from);
  // |from + t way| = radius; across / |way| is the distance of the line from the center.
  const double chord = radius * radius * size - across * across;
  if (!(chord >= 0) || !(along > 0)) return {};
  const double fraction = (along - std::sqrt(chord)) / size;
  if (!(fraction >= 0)) return {};
  return {fraction, radius > 0 ? direction_of(from + fraction * direction) : direction_of(-direction)};
}

/// Returns where the ray enters through the edge p .. p + e, moved out by `radius`, and longer by `tolerance`
/// at either end.
Entry enter_edge(Vec2d p, Vec2d e, double radius, Vec2d origin, Vec2d direction, double tolerance = 0) {
  const double length = std::sqrt(length_squared(e));
  if (!(length > 0)) return {};
  const Vec2d normal{e.y / length, -e.x / length};
  const double approach = -dot(normal, direction), height = dot(normal, origin - p) - radius;
  if (!(approach > 0) || !(height >= 0)) return {};
  const double fraction = height / approach;
  const double along = dot(origin + fraction * direction - p, e);
  const double beyond = tolerance * length;
  if (!(along >= -beyond) || !(along <= length * length + beyond)) return {};
  return {fraction, normal};
}

/// Clips the ray against the edges of a polygon without radius (Cyrus and Beck, 1978): no crack between two
/// edges. All edges are moved out by `tolerance`; the entry is where the ray meets the edge itself, from
/// outside.
template <class Real>
Entry enter_polygon(const Convex<Real>& shape, Vec2d origin, Vec2d direction, double tolerance) {
  Entry enter;
  double enter_moved = -kInfinity, leave = kInfinity;
  for (int i = 0; i < shape.count; ++i) {
    const Vec2d p = corner(shape, i), m = edge_normal(shape, i, p);
    const double height = dot(m, origin - p), approach = -dot(m, direction);
    const double moved = tolerance > 0 ? height - tolerance * std::sqrt(length_squared(m)) : height;
    if (approach > 0) {
      if (height >= 0 && moved >= enter_moved * approach)
        enter_moved = moved / approach, enter = {height / approach, m};
    } else if (approach < 0) {
      if (moved > leave * approach) leave = moved / approach;
    } else if (moved > 0) {
      return {};
    }
  }
  if (!(enter_moved <= leave) || !(leave >= 0)) return {};
  enter.normal = direction_of(enter.normal);
  return enter;
}

/// Returns where the ray enters a rounded hull. The hull is the union of the area within its corners, the
/// discs at the corners, and the edges moved out by the radius; the ray enters at the first of these.
template <class Real>
Entry enter_rounded(const Convex<Real>& shape, Vec2d origin, Vec2d direction) {
  const double radius = static_cast<double>(shape.radius);
  Entry first;
  for (int i = 0; i < shape.count; ++i) {
    const Vec2d p = corner(shape, i);
    const Entry disc = enter_disc(p, radius, origin, direction);
    if (disc.fraction < first.fraction) first = disc;
    if (shape.count == 1) break;
    const Entry edge = enter_edge(p, corner(shape, i + 1) - p, radius, origin, direction);
    if (edge.fraction < first.fraction) first = edge;
  }
  return first;
}

/// Returns where the ray crosses a line without thickness, which is longer by `tolerance` at either end.
template <class Real>
Entry enter_line(const Convex<Real>& shape, Vec2d origin, Vec2d direction, double tolerance) {
  const Vec2d p = corner(shape, 0), q = corner(shape, 1);
  const Entry there = enter_edge(p, q - p, 0, origin, direction, tolerance),
              back = enter_edge(q, p - q, 0, origin, direction, tolerance);
  return there.fraction < back.fraction ? there : back;
}

}  // namespace

template <class Real>
RayHit<Real> ray_cast(const Convex<Real>& shape, Vec2<Real> origin, Vec2<Real> translation,
                      double tolerance) {
  const Vec2d from = origin.template as<double>(), direction = translation.template as<double>();
  if (!(length_squared(direction) > 0) || contains(shape, origin)) return {};
  const bool rounded = shape.radius > 0;
  Entry entry = shape.count > 2 && !rounded ? enter_polygon(shape, from, direction, tolerance)
                                            : enter_rounded(shape, from, direction);
  if (entry.fraction == kInfinity && shape.count == 2 && !rounded)
    entry = enter_line(shape, from, direction, tolerance);
  if (!(entry.fraction <= 1)) return {};
  return {true, static_cast<Real>(entry.fraction), (from + entry.fraction * direction).template as<Real>(),
          entry.normal.template as<Real>()};
}

template <class Real>
RayHit<Real> ray_cast_one_sided(const Convex<Real>& segment, Vec2<Real> origin, Vec2<Real> translation,
                                double tolerance) {
  const Vec2d p = corner(segment, 0), front = outward(corner(segment, 1) - p);
  const bool from_front = dot(front, origin.template as<double>() - p) > 0;
  if (!from_front || !(dot(front, translation.template as<double>()) < 0)) return {};
  return ray_cast(segment, origin, translation, tolerance);
}

template <class Real>
bool contains(const Convex<Real>& shape, Vec2<Real> point) {
  const Vec2d x = point.template as<double>();
  if (shape.count > 2) {
    bool inside = true;
    for (int i = 0; i < shape.count && inside; ++i) {
      const Vec2d p = corner(shape, i);
      inside = !(dot(outward(corner(shape, i + 1) - p), x - p) > 0);
    }
    if (inside) return true;
    if (!(shape.radius > 0)) return false;
  }
  return nearest_from_outside(shape, x).distance <= static_cast<double>(shape.radius);
}

template <class Real>
SurfacePoint<Real> nearest_point(const Convex<Real>& shape, Vec2<Real> point) {
  const Nearest hull = nearest_on_hull(shape, point.template as<double>());
  const double radius = static_cast<double>(shape.radius);
  return {(hull.point + radius * hull.normal).template as<Real>(), hull.normal.template as<Real>(),
          static_cast<Real>(hull.distance - radius)};
}

#define PLUMB_INSTANTIATE(Real)                                                                  \
  template RayHit<Real> ray_cast(const Convex<Real>&, Vec2<Real>, Vec2<Real>, double);           \
  template RayHit<Real> ray_cast_one_sided(const Convex<Real>&, Vec2<Real>, Vec2<Real>, double); \
  template bool contains(const Convex<Real>&, Vec2<Real>);                                       \
  template SurfacePoint<Real> nearest_point(const Convex<Real>&, Vec2<Real>);
PLUMB_INSTANTIATE(float)
PLUMB_INSTANTIATE(double)
#undef PLUMB_INSTANTIATE

}  // namespace plumb
