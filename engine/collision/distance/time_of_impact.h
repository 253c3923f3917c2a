#pragma once

#include "engine/geometry/convex.h"
#include "engine/math/pose.h"

namespace plumb {

/// Motion of a body during an interval, with time as the fraction 0 .. 1 of it: its position is start +
/// fraction motion + fraction^2 curve, its rotation is the start's rotated by fraction delta_angle. Shapes
/// are given in the body's frame, whose origin (the centre of mass) moves along the parabola.
template <class Real>
struct Sweep {
  Vec2<Real> start{}, motion{};     ///< m
  Rotation<Real> start_rotation{};  ///< at fraction 0
  Real delta_angle = 0;             ///< rad over the interval, any number of turns
  Vec2<Real> curve{};               ///< m, half of the acceleration times the interval's square
};

/// Returns the body's pose at a fraction: computed in double precision, then rounded to Real.
template <class Real>
Pose<Real> pose_at(const Sweep<Real>& sweep, double fraction);

template <class Real>
struct ImpactResult {
  enum class State {
    Separated,   ///< the shapes are never closer than the target; fraction 1
    Hit,         ///< they reach the target distance at `fraction`, and not before
    Overlapped,  ///< they overlap at the start; fraction 0
    Failed       ///< iterations ran out: not closer than the target up to `fraction`, unknown after it
  };
  State state = State::Separated;
  Real fraction = 1;          ///< rounded towards 0
  double exact_fraction = 1;  ///< in double precision: a float is too coarse for fast bodies
  Vec2<Real> point{};         ///< m, half-way between the two surfaces at that time, in the world
  Vec2<Real> normal{};        ///< unit, from a to b, in the world
  int iterations = 0;
};

/// Default limit on the iterations of `time_of_impact`. The worst case seen is two per radian, for rods that
/// keep passing close by.
inline constexpr int kMostImpactIterations = 4096;

/// Finds when two moving shapes first come as close as `target_separation` (m, >= 0). At the fraction found,
/// their separation is between the target and the target + tolerance (m, > 0); before it, it is never less
/// than the target, at any speed or spin. A tolerance below the rounding of a double, relative to positions
/// and motions, is raised to it.
/// Shapes that start closer than the target (resting or sliding on each other) hit only if they come closer
/// than half of their initial distance.
/// Computed in double precision for both types of Real. Shapes in float may move in double: at 1e8 m/s the
/// displacement of a step is coarser in float than a bullet is large.
template <class Real, class Moving = Real>
ImpactResult<Real> time_of_impact(const Convex<Real>& a, const Sweep<Moving>& sweep_a, const Convex<Real>& b,
                                  const Sweep<Moving>& sweep_b, Real target_separation, Real tolerance,
                                  int most_iterations = kMostImpactIterations);

}  // namespace plumb
