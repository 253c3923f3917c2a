#pragma once

#include "engine/world/step/speculative_contact.h"
#include "engine/world/world_data.h"

namespace plumb {

/// Returns true if two dynamic bodies approach or turn so fast that the points and normal of their contact
/// change within the step: the deviation of a turning point from its tangent exceeds what a recycled manifold
/// tolerates. Only for bodies that no other dynamic body presses on, and that have joints or reach no third
/// one: in a crowd it would cost more than the crowd itself.
template <class Real>
bool turns_in_step(WorldData<Real>& w, const ContactConstraint<Real>& c, Real dt);

/// Returns true if two bodies reach no third one in the step, whatever their impact does to their velocities.
template <class Real>
bool are_alone(const WorldData<Real>& w, int body_a, int body_b, Real dt);

/// Returns true if a contact with points carries load at the start of a step of `dt`: it has an impulse, or
/// touches and will neither separate nor bounce.
template <class Real>
bool is_load_bearing(const WorldData<Real>& w, const ContactConstraint<Real>& c, Real dt);

/// Returns true if a contact has carried load in a step, after the solver: it had an impulse, or touches now
/// and will neither separate nor bounce. The separation of discs is measured along the normal at their
/// impact, which differs from the normal at the step's start.
template <class Real>
bool was_load_bearing(const WorldData<Real>& w, const ContactConstraint<Real>& c, Real dt);

/// Clears the expected impacts of the previous step.
template <class Real>
void clear_expected_impacts(WorldData<Real>& w);

/// Returns true if a contact's speculative contact `at` may be an impact in flight, with or without
/// restitution: it closes fast enough. `c` is the constraint made from `at`. The corners of a body strike one
/// after the other also without restitution; solved together, they would remove all of its spin.
template <class Real>
bool is_impact_in_flight(WorldData<Real>& w, const SpeculativeContact<Real>& at,
                         const ContactConstraint<Real>& c, Real dt);

/// Marks the two bodies of a contact that will carry load in this step: they are not in free flight.
template <class Real>
void mark_loaded(WorldData<Real>& w, int body_a, int body_b);

/// Decides between continuous collision and the solver for each expected impact. If nothing else constrains
/// either body, the contact has no points in this step. The bodies then rebound at the time of impact
/// (continuous.cpp). All other impacts are marked as left to the solver.
template <class Real>
void decide_expected_impacts(WorldData<Real>& w, Real dt);

}  // namespace plumb
