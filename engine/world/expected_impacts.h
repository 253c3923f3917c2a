#pragma once

#include "engine/world/encounter.h"
#include "engine/world/world_data.h"

namespace plumb {

/// Whether a contact with points holds its bodies: it presses, or touches without parting.
template <class Real>
bool holds(const WorldData<Real>& w, const ContactConstraint<Real>& c);

/// Forgets the expectations of the step before.
template <class Real>
void clear_expected_impacts(WorldData<Real>& w);

/// Whether the shapes of a contact, which is going to touch as `at` says, bounce there: fast enough, and with
/// restitution, and nobody is to be asked about it. `c` is the constraint made from `at`.
template <class Real>
bool will_bounce(const WorldData<Real>& w, const ContactRecord& contact, const Encounter<Real>& at,
                 const ContactConstraint<Real>& c, Real dt);

/// Notes that a contact is going to press on its bodies in this step: these do not fly freely.
template <class Real>
void note_pressed(WorldData<Real>& w, const ContactConstraint<Real>& c);

/// Decides about the expected impacts. Those of bodies that nothing else holds, nor those that they meet, are
/// left to free flight: their contacts have no points in this step, and the bodies are thrown back at the
/// time of the impact (continuous.cpp). All others are marked as left to the solver.
template <class Real>
void decide_expected_impacts(WorldData<Real>& w);

}  // namespace plumb
