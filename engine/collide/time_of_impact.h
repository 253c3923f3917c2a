#pragma once

#include "engine/geometry/convex.h"
#include "engine/math/pose.h"

namespace plumb {

/// Gives a body's motion during an interval, with time as the fraction 0 .. 1 of it: at start + fraction
/// motion
/// + fraction^2 curve, turned from its start by fraction turn. Shapes stand in the body's frame, whose origin
/// is what moves along the parabola: the centre of mass.
template <class Real>
struct Sweep {
  Vec2<Real> start{}, motion{};     ///< m
  Rotation<Real> start_rotation{};  ///< at fraction 0
  Real turn = 0;                    ///< rad over the interval, any number of turns
  Vec2<Real> curve{};               ///< m, half of the acceleration times the interval's square
};

/// Where the body is at a fraction: computed in double precision, then rounded to Real.
template <class Real>
Pose<Real> pose_at(const Sweep<Real>& sweep, double fraction);

template <class Real>
struct ImpactResult {
  enum class State {
    Separated,   ///< they keep their distance through the whole interval; fraction 1
    Hit,         ///< they come as close as the target at `fraction`, and never before
    Overlapped,  ///< they overlap at the start; fraction 0
    Failed  ///< the iterations allowed were too few: they keep their distance up to `fraction`; what follows
            ///< is unknown
  };
  State state = State::Separated;
  Real fraction = 1;          ///< rounded towards 0
  double exact_fraction = 1;  ///< in double precision: a float is too coarse for fast bodies
  Vec2<Real> point{};         ///< m, half-way between the two surfaces at that time, in the world
  Vec2<Real> normal{};        ///< unit, from a to b, in the world
  int iterations = 0;
};

/// Iterations that `time_of_impact` may take: the worst seen are two a radian, of rods that pass closely all
/// the time.
inline constexpr int kMostImpactIterations = 4096;

/// When two moving shapes first come as close as `target_separation` (m, >= 0). At the fraction found they
/// are between the target and the target + tolerance (m, > 0) apart; at no earlier time are they closer than
/// the target, at any speed or spin. A tolerance below the rounding of a double, relative to positions and
/// motions, is raised to it.
///
/// Shapes that already start closer than that (they rest or slide on each other) are stopped only where
/// they come closer than half of the distance they start with.
///
/// Computed in double precision for both types of Real. Shapes in float may move in double: at 1e8 m/s the
/// way of a step is coarser in float than a bullet is large.
template <class Real, class Moving = Real>
ImpactResult<Real> time_of_impact(const Convex<Real>& a, const Sweep<Moving>& sweep_a, const Convex<Real>& b,
                                  const Sweep<Moving>& sweep_b, Real target_separation, Real tolerance,
                                  int most_iterations = kMostImpactIterations);

}  // namespace plumb
