#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/world/continuous/rebound.h"
#include "engine/world/state/constants.h"

namespace plumb {

/// Tests the AABBs of a moving body's shapes against those of others, for the motions found by the solver.
/// This decides most pairs. Stores the terms that do not depend on the other body.
template <class Real>
class SweptAabbTest {
 public:
  SweptAabbTest(const WorldData<Real>& w, const SweptBody& swept, double dt)
      : w_(w),
        dt_(static_cast<Real>(dt)),
        moved_(w.motion[swept.body].delta_position),
        turned_(turned(swept.body)),
        path_deviation_(path_deviation(swept.body)),
        as_solved_(is_as_solved(swept)) {}

  /// Returns true if the bodies of both shapes move as the solver found.
  bool both_as_solved(int other_body) const {
    if (!as_solved_) return false;
    const SweptBody* swept = find_swept_body(w_, other_body);
    return swept == nullptr || is_as_solved(*swept);
  }
  /// Returns the separation beyond which two shapes have no impact, m.
  Real no_impact_distance(int shape, int other) const {
    return Real(4 * tuning::kImpactTolerance) * std::min(w_.forms[shape].extent, w_.forms[other].extent) +
           path_deviation_ + path_deviation(w_.shapes[other].body);
  }
  /// Returns true if the AABBs of two shapes are more than `distance` (m) apart throughout the step along the
  /// same axis. Assumes the solver's motions, which are straight, and bounds rotations by
  /// their arcs.
  bool stay_separated(int shape, int other, Real distance) const {
    const int body = w_.shapes[other].body;
    const Vec2<Real> relative = w_.motion[body].delta_position - moved_;
    const Aabb<Real>&box_a = w_.tight_aabbs[shape], &box_b = w_.tight_aabbs[other];
    // Far from the origin, AABBs are rounded as coarsely as positions.
    const Real size = std::max(std::abs(box_a.lower.x), std::abs(box_a.upper.x)) +
                      std::max(std::abs(box_a.lower.y), std::abs(box_a.upper.y));
    const Real threshold =
        distance + (turned_ + turned(body)) + 8 * std::numeric_limits<Real>::epsilon() * size;
    const auto apart = [&](Real gap, Real closed) { return std::min(gap, gap - closed) > threshold; };
    return apart(box_b.lower.x - box_a.upper.x, relative.x) ||
           apart(box_a.lower.x - box_b.upper.x, -relative.x) ||
           apart(box_b.lower.y - box_a.upper.y, relative.y) ||
           apart(box_a.lower.y - box_b.upper.y, -relative.y);
  }
  /// Returns true if the AABBs alone show that two shapes do not collide.
  bool cannot_collide(int shape, int other) const {
    return both_as_solved(w_.shapes[other].body) &&
           stay_separated(shape, other, no_impact_distance(shape, other));
  }

 private:
  static bool is_as_solved(const SweptBody& swept) { return !swept.changed && swept.arm == Vec2d{}; }
  // Returns the largest distance of a body's path from its chord: a quarter of the parabola's `curve`, m.
  Real path_deviation(int body) const {
    const SolverBody<Real>& motion = w_.motion[body];
    const Vec2<Real> curve = dt_ * motion.velocity - motion.delta_position;
    return w_.is_dynamic(body) ? Real(0.25) * (std::abs(curve.x) + std::abs(curve.y)) : Real(0);
  }
  Real turned(int body) const { return std::abs(w_.motion[body].delta_angle) * w_.extents[body]; }

  const WorldData<Real>& w_;
  Real dt_;
  Vec2<Real> moved_;
  Real turned_, path_deviation_;
  bool as_solved_;
};

}  // namespace plumb
