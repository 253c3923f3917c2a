#pragma once

#include "engine/world/contact_solver/contact_step.h"
#include "engine/world/world_data.h"

/// Direct solve of small islands of contacts, in addition to the iterations. Towers, and heavy loads
/// on light bodies, become as stable as a single contact. Islands with joints are chosen here too, and solved
/// in engine/world/islands/jointed_islands.h. Larger islands are solved by iterations alone.
namespace plumb {

/// Finds the islands and factorises their systems, at the start of a step of `dt`. Joints must be prepared.
template <class Real>
void prepare_direct_islands(WorldData<Real>& w, Real dt);

/// Renews the rows of a contact's island, or the impulses that they start from, after its points have changed
/// within the step. Does nothing if the island is solved by iterations.
template <class Real>
void renew_island_of(WorldData<Real>& w, const ContactConstraint<Real>& c);

/// Finds impulses that satisfy all rows of each island: with depenetration before bodies move (`push`),
/// without it afterwards.
template <class Real>
void solve_direct_islands(WorldData<Real>& w, const ContactStep<Real>& step, bool use_bias);

/// Scales the impulses of joints that were solved with their island, and of contacts at their bodies, so that
/// another solver may start from them.
template <class Real>
void hand_over_all(WorldData<Real>& w);

/// Makes contacts soft again.
template <class Real>
void finish_direct_islands(WorldData<Real>& w);

}  // namespace plumb
