#pragma once

#include "engine/collide/hull_distance.h"

namespace plumb {

/// The points of two shapes that are nearest to each other, in a's frame. Where the shapes overlap, they are
/// the deepest ones along `normal`, the direction of the least way out:
/// dot(point_b - point_a, normal) is the separation with its sign.
template <class Real>
struct DistanceResult {
  Vec2<Real> point_a{}, point_b{};  ///< m, on the surfaces
  Vec2<Real> normal{};              ///< unit, from a to b
  Real distance = 0;                ///< m, 0 when they overlap
  int iterations = 0;
};

/// The distance of two rounded convex shapes; those of `a` stand in a's frame, those of `b` in b's, which
/// lies at `b_in_a`. Computed in double precision for both types of Real: the error is a few roundings of
/// Real, relative to the sizes and the distance. `cache` may name where an earlier call ended.
template <class Real>
DistanceResult<Real> distance(const Convex<Real>& a, const Convex<Real>& b, const Pose<Real>& b_in_a,
                              SimplexCache* cache = nullptr);

}  // namespace plumb
