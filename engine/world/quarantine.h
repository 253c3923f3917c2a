#pragma once

#include "engine/world/world_data.h"

/// Bodies that go bad: a force law returned NaN, or a step led to a number that is none or beyond 1e12. They
/// are taken out of the motion with the state that they had before, and the others go on.
namespace plumb {

/// Takes the body out: no motion, no contacts, no queries see it, its joints let go. Told by an event.
/// Nothing happens to one that is out already. Throws Error when the world's settings want that instead.
template <class Real>
void quarantine_body(WorldData<Real>& w, int body, BadField field, double value);

/// Puts it back in, of the type that it had, where it is and as fast as it was.
template <class Real>
void release_body(WorldData<Real>& w, int body);

/// The type that the user gave the body, in quarantine or not.
template <class Real>
BodyType own_type(const WorldData<Real>& w, int body);
/// The record of a body that is in quarantine.
template <class Real>
QuarantinedBody& quarantine_of(WorldData<Real>& w, int body);

/// Whether the joint lets go because one of its bodies is in quarantine.
template <class Real>
bool lets_go(const WorldData<Real>& w, const JointRecord& joint) {
  return w.bodies[joint.body_a].quarantined || w.bodies[joint.body_b].quarantined;
}

/// An impulse, N s, and one about the centre of mass, N m s. A body that they would carry beyond all limits
/// is taken out instead.
template <class Real>
void push_body(WorldData<Real>& w, int body, Vec2d impulse, double angular_impulse);

/// Before a step: takes out the bodies whose loads would carry them beyond all limits within `dt`, before
/// anything else feels them.
template <class Real>
void quarantine_overloaded(WorldData<Real>& w, double dt);

/// Whether what a step made of a body is numbers, however large.
template <class Real>
bool is_finite_motion(const BodyMotion<Real>& motion) {
  const Real sum = motion.moved.x + motion.moved.y + motion.turned + motion.velocity.x + motion.velocity.y +
                   motion.angular_velocity;
  return sum - sum == 0;
}
/// Whether it is numbers that a world takes.
template <class Real>
bool is_sound_motion(const BodyMotion<Real>& motion);

/// After a step's solver: sees to the bodies in `scratch.bad_bodies`, whose motion is not sound and that have
/// not been moved. Those that flew freely, or are too fast, are taken out. Of those that a common failure
/// made not finite (a constraint passes it on) the fastest are taken out; the others stay where they are for
/// this step, without the impulses that they had, and go on with the velocity from before it.
template <class Real>
void quarantine_lost(WorldData<Real>& w, double dt);

}  // namespace plumb
