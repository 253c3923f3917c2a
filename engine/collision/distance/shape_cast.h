#pragma once

#include "engine/geometry/convex.h"
#include "engine/math/pose.h"

namespace plumb {

/// First hit of a moved shape on another one, in the frame of the shape at rest.
template <class Real>
struct CastResult {
  bool hit = false;
  bool overlapped = false;  ///< they overlap before the motion: a hit at fraction 0
  Real fraction = 1;        ///< of the translation, 0 .. 1; 1 without a hit
  Vec2<Real> point{};       ///< m, on the surface of a
  Vec2<Real> normal{};      ///< unit, from a to b
};

/// Moves b from `b_in_a` by `translation` (m, in a's frame) without rotation. Shapes that touch and separate,
/// or slide along each other, do not hit. Computed in double precision for both types of Real: the remaining
/// gap is a few roundings of a double, relative to sizes and translation, before the fraction is rounded to
/// Real. Points and lines are shapes like others.
/// For a chain segment `front` points to the side from which it can be hit, at any length; b has to start
/// there. It is hit only with a normal towards that side.
template <class Real>
CastResult<Real> shape_cast(const Convex<Real>& a, const Convex<Real>& b, const Pose<Real>& b_in_a,
                            Vec2<Real> translation, Vec2<Real> front = {});

}  // namespace plumb
