#pragma once

#include "engine/world/world_data.h"

namespace plumb {

/// Collects the contacts with restitution for soft steps, and circles that approach each other fast: their
/// normal is predicted for the time of contact. The other solvers apply restitution in
/// sequential_contacts.cpp and position_contacts.cpp; free bodies bounce in continuous/rebound.cpp.
template <class Real>
void collect_restitution_contacts(WorldData<Real>& w);

/// Removes from the velocities of mechanisms that may bounce what their joints forbid, at the start of a
/// step: what a game has set, an impulse or an explosion. The joints take up that part of the approach, so it
/// does not rebound.
template <class Real>
void stop_joint_rates(WorldData<Real>& w);

/// Propagates the impacts of a substep through contacts and joints. Returns false if the impacts are left to
/// the constraints.
template <class Real>
bool propagate_impacts(WorldData<Real>& w, const ContactStep<Real>& step);

/// Adds the impulses that joints have passed on in the impacts of the step to their loads, at its end.
template <class Real>
void add_impact_loads(WorldData<Real>& w, const JointStep<Real>& step);

}  // namespace plumb
