#pragma once

#include "engine/world/world_data.h"

/// Bodies whose state became non-finite or exceeded 1e12 (for example because a force law returned NaN). They
/// are removed from the simulation with their previous state, and the others continue.
namespace plumb {

/// Quarantines the body and reports it by an event: it has no motion, contacts or joint forces, and queries
/// skip it. Does nothing if it is quarantined already. Throws Error if the world's settings say so.
template <class Real>
void quarantine_body(WorldData<Real>& w, int body, BadField field, double value);

/// Disables the body in the same way at the program's request, without an event. Does nothing if it is in
/// quarantine.
template <class Real>
void disable_body(WorldData<Real>& w, int body);
/// Restores a body that `disable_body` removed.
template <class Real>
void enable_body(WorldData<Real>& w, int body);

/// Releases the body from quarantine, with its previous type, pose and velocity.
template <class Real>
void release_body(WorldData<Real>& w, int body);

/// Returns the type that the user gave the body, even in quarantine.
template <class Real>
BodyType own_type(const WorldData<Real>& w, int body);
/// Returns the record of a body in quarantine.
template <class Real>
QuarantinedBody& quarantine_of(WorldData<Real>& w, int body);

/// Returns true if the joint is disabled because one of its bodies is in quarantine.
template <class Real>
bool has_quarantined_body(const WorldData<Real>& w, const JointRecord& joint) {
  return w.bodies[joint.body_a].quarantined || w.bodies[joint.body_b].quarantined;
}

/// Applies an impulse, N s, and an angular one about the centre of mass, N m s. Quarantines a body that would
/// exceed the limits instead.
template <class Real>
void apply_body_impulse(WorldData<Real>& w, int body, Vec2d impulse, double angular_impulse);

/// Quarantines, before a step, bodies whose loads would take them beyond the limits within `dt`, before they
/// affect others.
template <class Real>
void quarantine_overloaded(WorldData<Real>& w, double dt);

/// Returns true if a body's motion is finite, of any magnitude.
template <class Real>
bool is_finite_motion(const SolverBody<Real>& motion) {
  const Real sum = motion.delta_position.x + motion.delta_position.y + motion.delta_angle +
                   motion.velocity.x + motion.velocity.y + motion.angular_velocity;
  return sum - sum == 0;
}
/// Returns true if a motion is finite and within the world's limits.
template <class Real>
bool is_valid_motion(const SolverBody<Real>& motion);

/// Returns true if a body's motion of a step leads to a position and an angle within the world's limits.
template <class Real>
bool stays_in_range(const WorldData<Real>& w, int body);

/// Handles the bodies in `scratch.nonfinite_bodies` after a step's solver: their motion is invalid and was
/// not applied. Quarantines bodies that were in free flight or too fast. If constraints spread a failure
/// among several bodies, quarantines the fastest. The others stay in place for this step, lose their
/// impulses, and continue with the velocity before it.
template <class Real>
void quarantine_diverged(WorldData<Real>& w, double dt);

}  // namespace plumb
