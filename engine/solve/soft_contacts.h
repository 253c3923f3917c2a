#pragma once

#include "engine/solve/body_motion.h"
#include "engine/solve/contact_graph.h"

namespace plumb {

/// What the passes over contacts need besides the constraints.
template <class Real>
struct ContactStep {
  Real h = 0, inverse_h = 0;        ///< s, 1/s, of the substep
  Softness<Real> softness[3][2]{};  ///< by ContactHardness; overlaps, and gaps, which are not softened
  Real warm_start = 1;        ///< this substep over the last one: impulses grow with the time they act in
  Real bounce_threshold = 0;  ///< m/s; slower impacts do not bounce
  Real push_with_load = 0;    ///< of the velocity that a load gives soft contacts' bodies, the share by which
                              ///< they are pushed out faster
};

/// Applies the impulses of the substep before: what was needed then is nearly what is needed now.
template <class Real>
void warm_start_contacts(BodyMotion<Real>* motion, ContactGraph<Real>& graph, const ContactStep<Real>& step);

/// Normal impulses with a bias that pushes overlaps out softly and lets gaps close: afterwards the positions
/// fit.
template <class Real>
void solve_contacts(BodyMotion<Real>* motion, ContactGraph<Real>& graph, const ContactStep<Real>& step);

/// Normal impulses without the push, friction and rolling resistance: afterwards the velocities fit.
template <class Real>
void relax_contacts(BodyMotion<Real>* motion, ContactGraph<Real>& graph, const ContactStep<Real>& step);

}  // namespace plumb
