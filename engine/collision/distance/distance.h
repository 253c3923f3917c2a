#pragma once

#include "engine/collision/distance/hull_distance.h"

namespace plumb {

/// The nearest points of two shapes, in a's frame. For overlapping shapes they are the deepest ones along
/// `normal`, the direction of least penetration: dot(point_b - point_a, normal) is the signed separation.
template <class Real>
struct DistanceResult {
  Vec2<Real> point_a{}, point_b{};  ///< m, on the surfaces
  Vec2<Real> normal{};              ///< unit, from a to b
  Real distance = 0;                ///< m, 0 when they overlap
  int iterations = 0;
};

/// Computes the distance of two rounded convex shapes. Corners of `a` are in a's frame, those of `b` in b's,
/// which lies at `b_in_a`. Computed in double precision for both types of Real: the error is a few roundings
/// of Real, relative to the sizes and the distance. `cache` may hold the result of an earlier call.
template <class Real>
DistanceResult<Real> distance(const Convex<Real>& a, const Convex<Real>& b, const Pose<Real>& b_in_a,
                              SimplexCache* cache = nullptr);

}  // namespace plumb
