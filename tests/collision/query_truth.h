#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "engine/geometry/convex.h"
#include "engine/math/pose.h"

/// Random convex shapes, and their distances in long double by a formulation of its own: the signed distance
/// of a point from the convex hull of all differences of corners. No iteration, no search from corner to
/// corner.
namespace plumb::query_truth {

using Wide = long double;
using Point = Vec2<Wide>;

inline constexpr Wide kPi = 3.14159265358979323846264338327950288L;

/// EXPECT_NEAR in long double.
inline testing::AssertionResult near(Wide got, Wide expected, Wide tolerance) {
  if (std::abs(got - expected) <= tolerance) return testing::AssertionSuccess();
  return testing::AssertionFailure() << got << " against " << expected << ": " << got - expected
                                     << " off, allowed " << tolerance;
}

/// A shape that owns its corners.
template <class Real>
struct Shape {
  std::vector<Corner<Real>> corners;
  Real radius = 0;
  Convex<Real> view() const { return {corners.data(), static_cast<int>(corners.size()), radius}; }
  operator Convex<Real>() const { return view(); }
};

/// Corners in counter-clockwise order, with the normals of their edges.
template <class Real>
Shape<Real> shape_of(const std::vector<Point>& points, Wide radius = 0) {
  Shape<Real> out;
  out.radius = static_cast<Real>(radius);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Point e = points[(i + 1) % points.size()] - points[i];
    const Wide length = std::sqrt(length_squared(e));
    const Point normal = length > 0 ? Point{e.y / length, -e.x / length} : Point{};
    out.corners.push_back({points[i].as<Real>(), normal.as<Real>()});
  }
  return out;
}

template <class Real>
Shape<Real> tight_aabb(Wide half_width, Wide half_height, Wide radius = 0) {
  const Wide w = half_width, h = half_height;
  return shape_of<Real>({{-w, -h}, {w, -h}, {w, h}, {-w, h}}, radius);
}

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double uniform(double low, double high) { return low + (high - low) * unit_(engine_); }
  int below(int count) { return static_cast<int>(engine_() % static_cast<unsigned>(count)); }
  bool chance(double p) { return uniform(0, 1) < p; }
  /// 10 to a power between both.
  double decade(double low, double high) { return std::pow(10.0, uniform(low, high)); }
  template <class Real>
  Rotation<Real> rotation() {
    const double angle = uniform(-4, 4);
    return {static_cast<Real>(std::cos(angle)), static_cast<Real>(std::sin(angle))};
  }
  Point direction() {
    const Wide angle = uniform(0, 6.283185307179586);
    return {std::cos(angle), std::sin(angle)};
  }

 private:
  std::mt19937 engine_;
  std::uniform_real_distribution<double> unit_;
};

/// A disc, segment, capsule, box, rod or polygon, rounded or not, about `size` m large.
template <class Real>
Shape<Real> random_shape(Random& random, double size, int max_corners = 10) {
  const double radius = random.chance(0.4) ? size * random.decade(-4, 0) : 0;
  switch (random.below(5)) {
    case 0:
      return shape_of<Real>({size * random.uniform(0, 1) * random.direction()}, radius);
    case 1: {
      const Point p = size * random.direction(), q = size * random.uniform(0, 1) * random.direction();
      return shape_of<Real>({p, q}, radius);
    }
    case 2:
      return tight_aabb<Real>(size * random.uniform(0.1, 1), size * random.uniform(0.1, 1), radius);
    case 3:
      return tight_aabb<Real>(size, size * random.decade(-4, -1), radius);
    default: {
      const int count = 3 + random.below(max_corners - 2);
      const double flat = random.uniform(0.2, 1), first = random.uniform(0, 6);
      const Point center = size * random.uniform(0, 1.5) * random.direction();
      std::vector<Point> points;
      for (int i = 0; i < count; ++i) {
        const Wide angle = first + 2 * kPi * (i + Wide(random.uniform(-0.4, 0.4))) / count;
        points.push_back(center + Point{size * std::cos(angle), flat * size * std::sin(angle)});
      }
      return shape_of<Real>(points, radius);
    }
  }
}

template <class Real>
std::vector<Point> points_of(const Convex<Real>& shape) {
  std::vector<Point> out;
  for (int i = 0; i < shape.count; ++i) out.push_back(shape.corners[i].point.template as<Wide>());
  return out;
}

template <class Real>
Pose<Wide> wide(const Pose<Real>& pose) {
  return {pose.position.template as<Wide>(), {pose.rotation.c, pose.rotation.s}};
}

template <class Real>
std::vector<Point> placed(const Convex<Real>& shape, const Pose<Wide>& pose) {
  std::vector<Point> out = points_of(shape);
  for (Point& p : out) p = pose.position + pose.rotation * p;
  return out;
}

/// The largest of n . p.
inline Wide support(const std::vector<Point>& points, Point n) {
  Wide most = -std::numeric_limits<Wide>::infinity();
  for (const Point& p : points) most = std::max(most, dot(n, p));
  return most;
}

/// Returns how far b lies beyond a along n: negative if they overlap there.
inline Wide gap_along(const std::vector<Point>& a, const std::vector<Point>& b, Point n) {
  return -support(b, -n) - support(a, n);
}

/// Andrew's monotone chain (1979), counter-clockwise.
inline std::vector<Point> hull_of(std::vector<Point> points) {
  const auto before = [](const Point& p, const Point& q) { return p.x < q.x || (p.x == q.x && p.y < q.y); };
  std::sort(points.begin(), points.end(), before);
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 3) return points;
  std::vector<Point> hull;
  for (int side = 0; side < 2; ++side) {
    const std::size_t start = hull.size();
    for (const Point& p : points) {
      while (hull.size() >= start + 2 &&
             cross(hull.back() - hull[hull.size() - 2], p - hull[hull.size() - 2]) <= 0)
        hull.pop_back();
      hull.push_back(p);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

inline Wide segment_distance(Point p, Point q, Point x) {
  const Point e = q - p;
  const Wide size = length_squared(e);
  const Wide part = size > 0 ? std::clamp(dot(x - p, e) / size, Wide(0), Wide(1)) : Wide(0);
  return std::sqrt(length_squared(x - (p + part * e)));
}

/// Of a point from a convex polygon (or segment, or point): negative inside.
inline Wide signed_distance(const std::vector<Point>& hull, Point x) {
  Wide outside = std::numeric_limits<Wide>::infinity(), inside = -outside;
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Point p = hull[i], q = hull[(i + 1) % hull.size()], e = q - p;
    outside = std::min(outside, segment_distance(p, q, x));
    if (hull.size() > 2) inside = std::max(inside, cross(x - p, e) / std::sqrt(length_squared(e)));
  }
  return hull.size() > 2 && inside <= 0 ? inside : outside;
}

/// The hull of all b - a: the origin is as far from it as the shapes are from each other.
inline std::vector<Point> difference_hull(const std::vector<Point>& a, const std::vector<Point>& b) {
  std::vector<Point> all;
  for (const Point& p : a)
    for (const Point& q : b) all.push_back(q - p);
  return hull_of(all);
}

/// The distance of two hulls as the least of all corners from all edges; 0 where a corner is inside or edges
/// cross.
inline Wide hull_gap(const std::vector<Point>& a, const std::vector<Point>& b) {
  Wide least = std::numeric_limits<Wide>::infinity();
  for (const Point& p : b) least = std::min(least, signed_distance(a, p));
  for (const Point& p : a) least = std::min(least, signed_distance(b, p));
  if (least <= 0) return 0;
  for (std::size_t i = 0; a.size() > 1 && i < a.size(); ++i)
    for (std::size_t j = 0; b.size() > 1 && j < b.size(); ++j) {
      const Point p = a[i], e = a[(i + 1) % a.size()] - p, q = b[j], f = b[(j + 1) % b.size()] - q;
      const Wide turn = cross(e, f), s = cross(q - p, f), t = cross(q - p, e);
      if (turn != 0 && s / turn >= 0 && s / turn <= 1 && t / turn >= 0 && t / turn <= 1) return 0;
    }
  return least;
}

/// Returns the argument in 0 .. 1 at which a convex function is least.
template <class Function>
Wide lowest_along(const Function& f) {
  Wide low = 0, high = 1;
  for (int i = 0; i < 160; ++i) {
    const Wide first = low + (high - low) / 3, second = high - (high - low) / 3;
    if (f(first) <= f(second)) {
      high = second;
    } else {
      low = first;
    }
  }
  return low;
}

}  // namespace plumb::query_truth
