#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "engine/geometry/convex.h"
#include "engine/math/pose.h"

namespace plumb {

/// The nearest corners of two shapes, from which the next search starts when the shapes have moved little.
/// Empty (count 0) at first. Belongs to one pair of shapes in one order.
struct SimplexCache {
  /// 0: empty; 1: a corner of each; 2: two corners of at least one shape, an edge.
  std::uint8_t count = 0;
  std::uint8_t corner_a[2] = {0, 0};
  std::uint8_t corner_b[2] = {0, 0};

  /// Returns true if an edge of a (of b) takes part, not a corner alone.
  bool edge_of_a() const { return count == 2 && corner_a[0] != corner_a[1]; }
  bool edge_of_b() const { return count == 2 && corner_b[0] != corner_b[1]; }
};

/// Returns the corner farthest along `direction`, in the shape's frame.
template <class Real>
int farthest_corner(const Convex<Real>& shape, Vec2d direction) {
  int best = 0;
  double most = dot(shape.corners[0].point.template as<double>(), direction);
  for (int i = 1; i < shape.count; ++i) {
    const double here = dot(shape.corners[i].point.template as<double>(), direction);
    if (here > most) most = here, best = i;
  }
  return best;
}

/// Returns the distance (m) from the origin of the shape's frame to its farthest corner.
template <class Real>
double corner_extent(const Convex<Real>& shape) {
  double square = 0;
  for (int i = 0; i < shape.count; ++i)
    square = std::max(square, length_squared(shape.corners[i].point.template as<double>()));
  return std::sqrt(square);
}

/// Distance of two hulls without their radii, in a's frame and in double precision.
struct HullDistance {
  Vec2d point_a{}, point_b{};  ///< m, on the hulls
  Vec2d normal{};              ///< unit, from a to b; the hulls' separation along it is `separation`, to
                               ///< rounding
  double separation = 0;       ///< m, negative where they overlap: minus the penetration depth
  int iterations = 0;
};

/// Computes the distance by the algorithm of Gilbert, Johnson and Keerthi (GJK, 1988) on the corners, and on
/// overlap the separating axis of least depth. Always terminates, with finite results for finite input. The
/// error is a few roundings of a double, relative to the distance and the sizes. `cache` may be null.
template <class Real>
HullDistance hull_distance(const Convex<Real>& a, const Convex<Real>& b, const Pose<double>& b_in_a,
                           SimplexCache* cache);

/// Finds the largest separation along an edge normal of either hull: for overlapping hulls the direction of
/// least penetration.
template <class Real>
HullDistance edge_separation(const Convex<Real>& a, const Convex<Real>& b, const Pose<double>& b_in_a);

/// Returns how far b lies beyond a along `normal` (unit, in a's frame), m: a lower bound of the distance.
template <class Real>
double separation_along(const Convex<Real>& a, const Convex<Real>& b, const Pose<double>& b_in_a,
                        Vec2d normal);

}  // namespace plumb
