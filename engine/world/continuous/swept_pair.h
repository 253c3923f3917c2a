#pragma once

#include <cmath>
#include <optional>

#include "engine/world/state/constants.h"
#include "engine/world/world_data.h"

namespace plumb {

/// Data shared by all time-of-impact searches of a step.
struct ImpactSearch {
  double dt = 0;                 ///< s, length of the step
  int toi_iteration_budget = 0;  ///< iterations left, see kToiIterationBudget
};

/// The motion of a body from a fraction of the step to its end, relative to its position then.
struct SweptPath {
  SweptPath(const SweptBody& swept_, double from_, ImpactSearch& search_)
      : swept(swept_),
        from(from_),
        origin(swept_.position_at(from_)),
        sweep(swept_.sweep(from_, origin)),
        search(search_) {}
  const SweptBody& swept;
  double from;
  Vec2d origin;
  Sweep<double> sweep;
  ImpactSearch& search;
};

/// Input of a search for one pair of shapes.
template <class Real>
struct SweptPair {
  int shape = 0, other = 0;                          ///< `shape` belongs to the moving body
  const ContactConstraint<Real>* contact = nullptr;  ///< the solver's constraint between the two; null: none
  bool other_stopped = false;  ///< the other body was stopped in front of it; it may penetrate
                               ///< as far as either's core permits
  bool aabbs_overlap = false;  ///< true if SweptAabbTest could not separate them
};

/// Returns the displacement that keeps a moving body out of a surface that it touched at the start of the
/// step, m; zero if its core ends outside. Returns nullopt if the body must be stopped instead, because it is
/// deeper, or because the other body rotates or is dynamic. Without this, a thin body that turns or slides on
/// a surface would stop for good, because its core is less deep than the overlap of a resting contact.
/// `entry_fraction`: fraction of the path at which its core enters; 1: unknown. A body with joints is lifted
/// only if it is a `blocked_link`, which would be stopped alone, and no joint holds it to one that is not
/// dynamic: its joints open by the lift.
template <class Real>
std::optional<Vec2d> lift_off(const WorldData<Real>& w, const SweptPath& path, const SweptPair<Real>& pair,
                              double entry_fraction = 1, bool blocked_link = false);

/// Returns true if a body that would be stopped at a fraction of the step is a link of a mechanism and has
/// not moved in this step: it began it where an obstacle had stopped it before.
template <class Real>
bool is_blocked_link(const WorldData<Real>& w, const SweptBody& swept, double fraction) {
  if (w.bodies[swept.body].first_joint == kNone) return false;
  const double extent = static_cast<double>(w.extents[swept.body]);
  const double turned = swept.delta_angle_before + swept.elapsed_fraction(fraction) * swept.delta_angle;
  return length(swept.position_at(fraction) - swept.step_start) + std::abs(turned) * extent <=
         tuning::kImpactTolerance * extent;
}

/// Returns the fraction of the step at which a moving body bounces off another shape or must be stopped in
/// front of it; 1: no impact. Tests the core (convex_core.h), not the surface: until a shape reaches the
/// core, contacts push both apart to their original sides.
template <class Real>
double fraction_of_impact(const WorldData<Real>& w, const SweptPath& path, const SweptPair<Real>& pair);

}  // namespace plumb
