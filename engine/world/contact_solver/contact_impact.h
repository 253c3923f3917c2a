#pragma once

#include "engine/world/contact_solver/contact_constraint.h"
#include "engine/world/contact_solver/solver_body.h"

namespace plumb {

/// Impulses of an impact at a contact, N s.
struct ImpactImpulses {
  double normal[2] = {}, friction = 0;
  bool jammed =
      false;  ///< friction leaves little mobility: the impulses nearly cancel, and are not to be rounded
};

/// Returns the impulses of an impact at one or both points of a contact, by Newton's law of restitution and
/// Coulomb's law for the impulses. With u the velocities along the normal after the impact and s the
/// remaining slip,
///   u >= target, lambda >= 0, lambda > 0 only where u = target;
///   |tau| <= mu sum of lambda, and tau = -+mu sum of lambda where +-s > 0.
/// Friction changes u and lambda changes s, so both are solved together. The solver tries the few
/// combinations of pressing points with sticking or slipping, and takes the one that meets all conditions.
/// The slip may stop or reverse within the impact. Newton's law with friction may gain energy (Kane and
/// Levinson 1985): in that case all impulses are scaled back until none is gained. If no combination meets
/// the conditions because friction jams the bodies (Painleve), or the scaled impulses leave an approach, the
/// points follow Coulomb's law one after the other while their normal impulse grows, up to the target, to the
/// energy that they have lost before, or to where a larger impulse has no effect.
///
/// Only points in `may_press` may have an impulse: points that touch, and either approach or are pressed by
/// the impulse at the other point. `target`: m/s.
template <class Real>
ImpactImpulses solve_impact(const SolverBody<Real>& a, const SolverBody<Real>& b,
                            const ContactConstraint<Real>& c, const bool (&may_press)[2],
                            const double (&target)[2]);

}  // namespace plumb
