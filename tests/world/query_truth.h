#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <random>
#include <vector>

#include "engine/world/world.h"

/// Answers to queries by brute force over all shapes, in long double: rays against lines and circles,
/// distances of points and lines. No tree, no iteration, nothing of the engine but where its bodies are.
namespace plumb::query_truth {

using Wide = long double;
using Point = Vec2<Wide>;
inline constexpr Wide kNever = std::numeric_limits<Wide>::infinity();

/// Corners in the plane, in order, and the radius around their hull.
struct Outline {
  std::vector<Point> corners{};
  Wide radius = 0;
};

inline Wide norm(Point v) { return std::sqrt(length_squared(v)); }

inline Wide point_to_line(Point x, Point p, Point q) {
  const Point e = q - p;
  const Wide size = length_squared(e);
  const Wide part = size > 0 ? std::clamp(dot(x - p, e) / size, Wide(0), Wide(1)) : 0;
  return norm(x - (p + part * e));
}

/// Calls visit(p, q) for each edge; a single corner is an edge without length.
template <class Visit>
void for_each_edge(const Outline& shape, const Visit& visit) {
  const std::size_t count = shape.corners.size();
  for (std::size_t i = 0; i < (count < 3 ? 1 : count); ++i)
    visit(shape.corners[i], shape.corners[(i + 1) % count]);
}

/// By the number of edges that a line to the right crosses.
inline bool inside_corners(const Outline& shape, Point x) {
  if (shape.corners.size() < 3) return false;
  bool inside = false;
  for_each_edge(shape, [&](Point p, Point q) {
    if ((p.y > x.y) != (q.y > x.y) && x.x < p.x + (x.y - p.y) / (q.y - p.y) * (q.x - p.x)) inside = !inside;
  });
  return inside;
}

/// m, negative inside.
inline Wide signed_distance(const Outline& shape, Point x) {
  Wide least = kNever;
  for_each_edge(shape, [&](Point p, Point q) { least = std::min(least, point_to_line(x, p, q)); });
  return (inside_corners(shape, x) ? -least : least) - shape.radius;
}

inline Wide ray_to_circle(Point x, Point way, Point centre, Wide radius) {
  const Point from = x - centre;
  const Wide a = length_squared(way), b = dot(from, way), c = length_squared(from) - radius * radius;
  const Wide root = b * b - a * c;
  if (root < 0) return kNever;
  const Wide fraction = (-b - std::sqrt(root)) / a;
  return fraction >= 0 && fraction <= 1 ? fraction : kNever;
}

inline Wide ray_to_line(Point x, Point way, Point p, Point q) {
  const Point e = q - p;
  const Wide det = cross(way, e);
  if (det == 0) return kNever;
  const Wide fraction = cross(p - x, e) / det, along = cross(p - x, way) / det;
  return fraction >= 0 && fraction <= 1 && along >= 0 && along <= 1 ? fraction : kNever;
}

/// Returns the place at which a ray that starts outside first meets the points within `radius` of the line p
/// q.
inline Wide ray_to_capsule(Point x, Point way, Point p, Point q, Wide radius) {
  Wide first = kNever;
  if (radius > 0) first = std::min(ray_to_circle(x, way, p, radius), ray_to_circle(x, way, q, radius));
  const Wide length = norm(q - p);
  if (!(length > 0)) return first;
  const Point side = (radius / length) * perpendicular(q - p);
  return std::min({first, ray_to_line(x, way, p + side, q + side), ray_to_line(x, way, p - side, q - side)});
}

inline Wide ray_fraction(const Outline& shape, Point x, Point way) {
  if (signed_distance(shape, x) <= 0) return kNever;
  Wide first = kNever;
  for_each_edge(
      shape, [&](Point p, Point q) { first = std::min(first, ray_to_capsule(x, way, p, q, shape.radius)); });
  return first;
}

/// Distance of two shapes; where they overlap some number <= 0.
inline Wide gap(const Outline& a, const Outline& b) {
  Wide least = kNever;
  for_each_edge(a, [&](Point p, Point q) {
    for_each_edge(b, [&](Point r, Point s) {
      if (ray_to_line(p, q - p, r, s) < kNever) least = 0;
      least = std::min({least, point_to_line(p, r, s), point_to_line(q, r, s), point_to_line(r, p, q),
                        point_to_line(s, p, q)});
    });
  });
  if (inside_corners(a, b.corners[0]) || inside_corners(b, a.corners[0])) least = 0;
  return least - a.radius - b.radius;
}

/// When b, moved by `way`, first touches a. The first touch is of a corner with an edge, or of two corners.
inline Wide cast_fraction(const Outline& a, const Outline& b, Point way) {
  if (gap(a, b) <= 0) return 0;
  const Wide radius = a.radius + b.radius;
  Wide first = kNever;
  const auto meet = [&](const std::vector<Point>& corners, const Outline& edges, Point moved) {
    for (const Point corner : corners) {
      for_each_edge(edges, [&](Point p, Point q) {
        first = std::min(first, ray_to_capsule(corner, moved, p, q, radius));
      });
    }
  };
  meet(b.corners, a, way);
  meet(a.corners, b, -way);
  return first;
}

/// A shape's geometry as corners, counter-clockwise.
inline Outline outline_of(const ShapeGeometry& geometry) {
  if (const auto* circle = std::get_if<Circle>(&geometry)) return {{{0, 0}}, circle->radius};
  if (const auto* box = std::get_if<Box>(&geometry)) {
    const Wide w = Wide(box->width) / 2, h = Wide(box->height) / 2;
    return {{{-w, -h}, {w, -h}, {w, h}, {-w, h}}, 0};
  }
  Outline out;
  if (const auto* capsule = std::get_if<Capsule>(&geometry)) {
    return {{capsule->start.as<Wide>(), capsule->end.as<Wide>()}, capsule->radius};
  }
  if (const auto* segment = std::get_if<Segment>(&geometry)) {
    return {{segment->start.as<Wide>(), segment->end.as<Wide>()}, 0};
  }
  const Polygon& polygon = std::get<Polygon>(geometry);
  for (const Vec2d point : polygon.points) out.corners.push_back(point.as<Wide>());
  out.radius = polygon.radius;
  return out;
}

inline Outline placed(const Outline& shape, Point position, Wide angle) {
  Outline out{{}, shape.radius};
  const Rotation<Wide> q{std::cos(angle), std::sin(angle)};
  for (const Point corner : shape.corners) out.corners.push_back(position + q * corner);
  return out;
}

/// Random numbers with the same sequence everywhere.
class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine_()) / 4294967296.0);
  }
  int below(int count) { return static_cast<int>(engine_() % static_cast<unsigned>(count)); }
  bool chance(double p) { return uniform(0, 1) < p; }
  Vec2d within(double size) { return {uniform(-size, size), uniform(-size, size)}; }

 private:
  std::mt19937 engine_;
};

/// Some 0.2 to 4 m large.
inline ShapeGeometry random_geometry(Random& random) {
  switch (random.below(5)) {
    case 0:
      return Circle{random.uniform(0.1, 1.5)};
    case 1:
      return Box{random.uniform(0.1, 3), random.uniform(0.1, 3)};
    case 2:
      return Capsule{random.within(1), random.within(1), random.uniform(0.05, 0.8)};
    case 3:
      return Segment{random.within(1), random.within(1) + Vec2d{2.5, 0}};
    default: {
      Polygon polygon;
      const int count = 3 + random.below(6);
      for (int i = 0; i < count; ++i) {
        const double angle = 6.283185307179586 * (i + random.uniform(-0.3, 0.3)) / count;
        polygon.points.push_back({1.5 * std::cos(angle), 0.8 * std::sin(angle)});
      }
      if (random.chance(0.5)) polygon.radius = random.uniform(0.05, 0.5);
      return polygon;
    }
  }
}

}  // namespace plumb::query_truth
