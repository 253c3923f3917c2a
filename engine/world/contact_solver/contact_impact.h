#pragma once

#include "engine/world/contact_solver/body_motion.h"
#include "engine/world/contact_solver/contact_constraint.h"

namespace plumb {

/// Impulses of a contact, N s.
struct ContactImpulses {
  double normal[2] = {}, friction = 0;
};

/// Returns the impulses of an impact at one or both points of a contact, by Newton's law and Coulomb's for
/// the impulses. With u the rates along the normal after it and s the slip that is left,
///   u >= wanted, lambda >= 0, lambda > 0 only where u = wanted;
///   |tau| <= mu sum of lambda, and tau = -+mu sum of lambda where +-s > 0.
/// Friction changes u and lambda changes s, so that they are found together: of the few ways in which points
/// may push and the contact stick or slip the one that meets all conditions. The slip may stop, or turn
/// round, within the impact. Newton's law with friction may gain energy (Kane and Levinson 1985): then all
/// impulses are scaled back until none is gained.
///
/// Only points in `strikes` may have one: those that touch, whether they approach or are pressed on by the
/// other point's. `wanted`: m/s.
template <class Real>
ContactImpulses impact_of(const BodyMotion<Real>& a, const BodyMotion<Real>& b,
                          const ContactConstraint<Real>& c, const bool (&strikes)[2],
                          const double (&wanted)[2]);

}  // namespace plumb
