#pragma once

#include "engine/world/contact_solver/body_motion.h"
#include "engine/world/contact_solver/contact_graph.h"

namespace plumb {

/// Settings of the passes over contacts.
template <class Real>
struct ContactStep {
  Real h = 0, inverse_h = 0;        ///< s, 1/s, of the substep
  Softness<Real> softness[3][2]{};  ///< by ContactHardness; of overlaps, and of gaps (not softened)
  Real warm_start = 1;        ///< ratio of this substep's length to the last one's: impulses scale with it
  Real bounce_threshold = 0;  ///< m/s; slower impacts do not bounce
  Real push_with_load = 0;  ///< fraction of the velocity change by a load that is added to the depenetration
                            ///< speed of soft contacts
};

/// Warm starts: applies the impulses of the last substep, which are nearly those needed now.
template <class Real>
void warm_start_contacts(BodyMotion<Real>* motion, ContactGraph<Real>& graph, const ContactStep<Real>& step);

/// Solves normal impulses with a bias that removes overlaps softly and lets gaps close: corrects positions.
template <class Real>
void solve_contacts(BodyMotion<Real>* motion, ContactGraph<Real>& graph, const ContactStep<Real>& step);

/// Solves normal impulses without bias, friction and rolling resistance: corrects velocities.
template <class Real>
void relax_contacts(BodyMotion<Real>* motion, ContactGraph<Real>& graph, const ContactStep<Real>& step);

}  // namespace plumb
