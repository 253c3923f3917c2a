#pragma once

#include "engine/world/contact_solver/contact_step.h"
#include "engine/world/world_data.h"

/// Bounds the energy that contacts give to their bodies. Iterations do not converge within a substep: where
/// friction wedges bodies, the impulses of an impact act on after it, and crowds of equal boxes left it with
/// up to 1.2 times their energy.
namespace plumb {

/// Begins a step of `dt`, after its velocity increments and islands are prepared. Gains are bounded in it if
/// any body has more kinetic energy than gravity gives it in the step: what rests costs no more than this
/// test.
template <class Real>
void begin_contact_gains(WorldData<Real>& w, Real dt);

/// Scales the contact impulses of each island that gained kinetic energy in a substep, after relaxation, by
/// the largest fraction at which it did not. Momentum is conserved, as each impulse acts on both its bodies.
/// An island may gain the work of contacts that push an overlap apart, and what the substep's forces would
/// give it from rest: impulses that carry a load may be off by as much. Left out are islands to which others
/// than contacts give energy: those with joints, conveyors, or kinematic bodies. Needs known islands;
/// otherwise does nothing.
template <class Real>
void bound_contact_gains(WorldData<Real>& w, const ContactStep<Real>& step);

}  // namespace plumb
