#pragma once

#include <algorithm>
#include <cmath>
#include <random>
#include <span>
#include <vector>

#include "engine/collision/manifold/contact_manifold.h"
#include "engine/math/trigonometry.h"
#include "tests/geometry/rounded_corners.h"

/// Computes how two convex shapes lie to each other in another way than the engine: by the hull of all
/// differences of their corners (the Minkowski difference), in long double.
namespace plumb::truth {

using Long = long double;
using Vec2l = Vec2<Long>;

/// A shape that owns its corners.
template <class Real>
struct Solid {
  std::vector<Corner<Real>> corners;
  Real radius = 0;

  Solid() = default;
  Solid(const Corners& exact, double rounding)
      : corners(rounded_to<Real>(exact)), radius(static_cast<Real>(rounding)) {}
  Convex<Real> view() const { return {corners.data(), static_cast<int>(corners.size()), radius}; }
};

template <class Real>
std::vector<Vec2l> points_of(const Solid<Real>& solid, const Pose<Real>& pose = {}) {
  std::vector<Vec2l> out;
  const Rotation<Long> q{pose.rotation.c, pose.rotation.s};
  for (const Corner<Real>& corner : solid.corners)
    out.push_back(pose.position.template as<Long>() + q * corner.point.template as<Long>());
  return out;
}

/// Gift wrapping: slow, and unlike the engine's hull.
inline std::vector<Vec2l> wrap(const std::vector<Vec2l>& points) {
  std::size_t start = 0;
  for (std::size_t i = 1; i < points.size(); ++i)
    if (points[i].x < points[start].x || (points[i].x == points[start].x && points[i].y < points[start].y))
      start = i;
  std::vector<Vec2l> hull;
  std::size_t at = start;
  do {
    hull.push_back(points[at]);
    std::size_t next = at;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (points[i] == points[at]) continue;
      if (next == at) {
        next = i;
        continue;
      }
      const Vec2l u = points[next] - points[at], v = points[i] - points[at];
      const Long turn = cross(u, v);
      if (turn < 0 || (turn == 0 && length_squared(v) > length_squared(u))) next = i;
    }
    if (next == at) break;
    at = next;
  } while (!(points[at] == points[start]) && hull.size() <= points.size());
  return hull;
}

struct Apart {
  Long distance = 0;    ///< of the hulls, radii not counted; negative: the depth
  Vec2l normal{};       ///< from a to b; zero when the distance is 0
  bool corner = false;  ///< two corners are nearest
};

/// The signed distance of the hulls.
inline Apart between(const std::vector<Vec2l>& a, const std::vector<Vec2l>& b) {
  std::vector<Vec2l> differences;
  for (const Vec2l p : a)
    for (const Vec2l q : b) differences.push_back(q - p);
  const std::vector<Vec2l> hull = wrap(differences);
  bool inside = hull.size() > 2;
  Long least = INFINITY;
  Vec2l nearest{};
  bool corner = false;
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Vec2l u = hull[i], v = hull[(i + 1) % hull.size()], edge = v - u;
    if (cross(edge, Vec2l{} - u) <= 0) inside = false;
    const Long square = length_squared(edge);
    const Long share = square > 0 ? std::clamp(-dot(u, edge) / square, Long{0}, Long{1}) : Long{0};
    const Vec2l foot = u + share * edge;
    if (const Long distance = std::sqrt(length_squared(foot)); distance < least)
      least = distance, nearest = foot, corner = share == 0 || share == 1;
  }
  Apart out;
  out.distance = inside ? -least : least;
  if (least > 0) out.normal = (1 / out.distance) * nearest;
  out.corner = corner && !inside;
  return out;
}

/// The distance of the hulls as seen along a direction: never more than the signed distance.
inline Long along(const std::vector<Vec2l>& a, const std::vector<Vec2l>& b, Vec2l normal) {
  Long least = INFINITY;
  for (const Vec2l p : a)
    for (const Vec2l q : b) least = std::min(least, dot(normal, q - p));
  return least;
}

/// Shapes and poses from a fixed seed.
class Dice {
 public:
  explicit Dice(unsigned seed) : bits_(seed) {}

  double number(double low, double high) {
    return low + (high - low) * (static_cast<double>(bits_() >> 11) * 0x1p-53);
  }
  int integer(int low, int high) {
    return low + static_cast<int>(bits_() % static_cast<unsigned>(high - low + 1));
  }
  Vec2d point(double size) {
    const double x = number(-size, size);
    return {x, number(-size, size)};
  }

  enum Kind { Disc, Capsule, Box, Polygon };

  /// Corners within about `size` of the origin.
  Corners corners(Kind kind, double size) {
    switch (kind) {
      case Disc:
        return disc_corner(point(0.5 * size));
      case Capsule: {
        const Vec2d first = point(size);
        const double length = size * number(0.1, 1);
        return capsule_corners(first, first + length * direction());
      }
      case Box: {
        const double half_width = size * number(0.1, 1), half_height = size * number(0.1, 1);
        const Vec2d center = point(0.3 * size);
        return box_corners(half_width, half_height, center, rotation_of(number(-4, 4)));
      }
      default: {
        std::vector<Vec2d> points;
        const int count = integer(3, 12);
        for (int i = 0; i < count; ++i) {
          const double distance = size * number(0.5, 1);
          points.push_back(distance * direction());
        }
        try {
          return convex_hull(points);
        } catch (const std::exception&) {  // three points that happen to be in a line
          return box_corners(size, size);
        }
      }
    }
  }
  Vec2d direction() {
    const Rotation<double> q = rotation_of(number(-4, 4));
    return {q.c, q.s};
  }

 private:
  std::mt19937_64 bits_;
};

}  // namespace plumb::truth
