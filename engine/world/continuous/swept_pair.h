#pragma once

#include <optional>

#include "engine/world/world_data.h"

namespace plumb {

/// Data shared by all time-of-impact searches of a step.
struct ImpactSearch {
  double dt = 0;                 ///< s, length of the step
  int toi_iteration_budget = 0;  ///< iterations left, see kToiIterationBudget
};

/// The remaining motion of a body in this step, from a fraction of it on, relative to its start.
struct Way {
  Way(const SweptBody& flight_, double from_, ImpactSearch& search_)
      : flight(flight_),
        from(from_),
        origin(flight_.start_at(from_)),
        sweep(flight_.sweep(from_, origin)),
        search(search_) {}
  const SweptBody& flight;
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
  bool stands = false;      ///< the other one was stopped in front of it; it may penetrate that as far as
                            ///< either's core permits
  bool boxes_meet = false;  ///< true if their AABBs are known not to stay apart (swept_boxes.h)
};

/// Returns the displacement that keeps a moving body out of a surface that it touched at the start of the
/// step, m; zero if its core ends outside. Returns nullopt if the body must be stopped instead, because it is
/// deeper, or because the touched body rotates or is dynamic. Without this, a thin body that turns or slides
/// on a surface would stop for good: its core is less deep than the overlap at which contacts rest.
/// `entered`: fraction of the path at which its core enters, 1 if that is not known.
template <class Real>
std::optional<Vec2d> lift_off(const WorldData<Real>& w, const Way& way, const SweptPair<Real>& pair,
                              double entered = 1);

/// Returns the fraction of the step at which a moving body must be stopped, or bounces, in front of another
/// shape; 1 if it passes through nothing. The core (convex_core.h) decides, not the surface: until something
/// reaches the core, contacts push the shapes apart on their original sides.
template <class Real>
double fraction_of_impact(const WorldData<Real>& w, const Way& way, const SweptPair<Real>& pair);

}  // namespace plumb
