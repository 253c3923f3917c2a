#pragma once

#include "engine/world/world_data.h"

namespace plumb {

/// Collects the restitution contacts of soft steps, and circles that approach each other fast, whose normal
/// is predicted for the time of contact. The other solvers apply restitution in sequential_contacts.cpp and
/// position_contacts.cpp; free bodies bounce in continuous/rebound.cpp.
template <class Real>
void collect_restitution_contacts(WorldData<Real>& w);

/// Propagates the impacts of a substep, by contacts and by joints. Returns false if they are left to the
/// constraints.
template <class Real>
bool propagate_impacts(WorldData<Real>& w, const ContactStep<Real>& step);

}  // namespace plumb
