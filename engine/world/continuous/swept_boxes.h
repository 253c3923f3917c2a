#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/world/continuous/rebound.h"
#include "engine/world/state/constants.h"

namespace plumb {

/// Tests the AABBs of a moving body's shapes against those of others, for the motions found by the solver.
/// This decides most pairs. Terms that do not depend on the other body are computed once.
template <class Real>
class SweptBoxes {
 public:
  SweptBoxes(const WorldData<Real>& w, const SweptBody& flight, double dt)
      : w_(w),
        dt_(static_cast<Real>(dt)),
        moved_(w.motion[flight.body].moved),
        turned_(turned(flight.body)),
        bend_(bend(flight.body)),
        straight_(is_straight(flight)) {}

  /// Returns true if the bodies of both shapes move as the solver found.
  bool both_straight(int other_body) const {
    if (!straight_) return false;
    const SweptBody* flight = flight_in(w_, other_body);
    return flight == nullptr || is_straight(*flight);
  }
  /// Returns the separation beyond which two shapes have no impact, m.
  Real apart(int shape, int other) const {
    return Real(4 * tuning::kImpactTolerance) * std::min(w_.forms[shape].extent, w_.forms[other].extent) +
           bend_ + bend(w_.shapes[other].body);
  }
  /// Returns true if the AABBs of two shapes are more than `apart` (m) from each other throughout the step,
  /// along one and the same axis. Assumes the solver's motions, which are straight, and bounds rotations by
  /// their arcs.
  bool stay_apart(int shape, int other, Real apart) const {
    const int body = w_.shapes[other].body;
    const Vec2<Real> way = w_.motion[body].moved - moved_;
    const Aabb<Real>&box_a = w_.boxes[shape], &box_b = w_.boxes[other];
    // Far from the origin boxes are rounded as coarsely as positions.
    const Real size = std::max(std::abs(box_a.lower.x), std::abs(box_a.upper.x)) +
                      std::max(std::abs(box_a.lower.y), std::abs(box_a.upper.y));
    const Real least = apart + (turned_ + turned(body)) + 8 * std::numeric_limits<Real>::epsilon() * size;
    const auto clear = [&](Real gap, Real closed) { return std::min(gap, gap - closed) > least; };
    return clear(box_b.lower.x - box_a.upper.x, way.x) || clear(box_a.lower.x - box_b.upper.x, -way.x) ||
           clear(box_b.lower.y - box_a.upper.y, way.y) || clear(box_a.lower.y - box_b.upper.y, -way.y);
  }
  /// Returns true if the AABBs alone show that two shapes do not collide.
  bool are_clear(int shape, int other) const {
    return both_straight(w_.shapes[other].body) && stay_apart(shape, other, apart(shape, other));
  }

 private:
  static bool is_straight(const SweptBody& flight) { return !flight.changed && flight.arm == Vec2d{}; }
  // Returns the deviation of a body's path from its chord: of a parabola at most a quarter of its curve, m.
  Real bend(int body) const {
    const BodyMotion<Real>& motion = w_.motion[body];
    const Vec2<Real> curve = dt_ * motion.velocity - motion.moved;
    return w_.is_dynamic(body) ? Real(0.25) * (std::abs(curve.x) + std::abs(curve.y)) : Real(0);
  }
  Real turned(int body) const { return std::abs(w_.motion[body].turned) * w_.extents[body]; }

  const WorldData<Real>& w_;
  Real dt_;
  Vec2<Real> moved_;
  Real turned_, bend_;
  bool straight_;
};

}  // namespace plumb
