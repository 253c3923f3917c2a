#pragma once

#include "engine/world/contact_solver/contact_step.h"
#include "engine/world/world_data.h"

/// Contacts whose points and normal change within a step, because their bodies turn fast or are hit: a body
/// that strikes with one corner turns, and comes down with the next. Their points are computed again in each
/// substep.
namespace plumb {

/// Drops from the turning contacts that the narrow phase has found those that it ended again, or that bounce.
template <class Real>
void collect_turning_contacts(WorldData<Real>& w);

/// Computes the points of turning contacts for the next substep of `h`, s: those at the time of impact along
/// the bodies' present velocities, or at the substep's end if they touch now. Contacts of shapes that pass
/// each other get no impulses. Returns true if there are any.
template <class Real>
bool renew_turning_contacts(WorldData<Real>& w, Real h);

/// Solves turning contacts again, between the solution of a substep and its motion, at the points that the
/// velocities found would drive into each other. Contacts of bodies with joints are left as they are.
template <class Real>
void solve_turning_contacts(WorldData<Real>& w, const ContactStep<Real>& step);

}  // namespace plumb
