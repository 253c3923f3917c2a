#pragma once

#include <algorithm>
#include <span>

#include "engine/world/contact_solver/contact_constraint.h"
#include "engine/world/contact_solver/contact_step.h"

namespace plumb {

/// Time and speed of the bounce in the substep, of a contact with restitution or of discs that approach fast.
template <class Real>
struct RestitutionContact {
  ContactConstraint<Real>* contact = nullptr;
  Real before[2] = {};  ///< m/s, velocity along the normal at the start of the substep
  Real speed[2] = {};   ///< m/s, separating speed of the points at the end of the substep
  bool strikes[2] = {};
  bool closes = false;   ///< fast enough to bounce
  bool passes = false;   ///< disabled in this substep; the impact comes in a later one
  Real radii = 0;        ///< m, sum of radii of two separated discs with centred shapes; else 0
                         ///< for other shapes
  Real masses[5] = {};   ///< of the contact, while it is disabled
  Vec2<Real> between{};  ///< m, between the discs' centres (a to b), at the start of the step
};

/// Returns the velocity of a contact point along the normal, m/s; negative: closing.
template <class Real>
Real velocity_along_normal(const SolverBody<Real>* motion, const ContactConstraint<Real>& c, int i) {
  const SolverBody<Real>&a = motion[c.body_a], &b = motion[c.body_b];
  return dot(c.normal, b.velocity - a.velocity) +
         (c.arm_b[i] * b.angular_velocity - c.arm_a[i] * a.angular_velocity);
}

/// Records the approach speed of an impact: the fastest of a step.
template <class Real>
void note_approach(ContactConstraint<Real>& c, int i, Real rate) {
  const bool first = c.peak_impulse[i] == 0;
  c.approach[i] = first ? rate : std::min(c.approach[i], rate);
}

/// Rotates the normal of two separated discs to that of their contact between `from` and `h`, or else of
/// their closest approach. With p the vector between the centres and v its rate, the contact is at |p + v t|
/// = R. The normal rotates by an angle until then; the current one would deflect the discs by this angle.
/// After an impact at `from` that leaves the discs sliding, t = `from` is a double root, and rounding could
/// give an earlier root, at which they still approach.
template <class Real>
void face(const SolverBody<Real>* motion, RestitutionContact<Real>& bounce, Real h, Real from);

// The functions below treat each contact by itself: threads may share them.

/// Records the approach speed of points before any impulse acts. Contacts that separate after a bounce must
/// not be warm started: returns true if one of these had an impulse.
template <class Real>
bool note_approaches(const SolverBody<Real>* motion, std::span<RestitutionContact<Real>> bounces,
                     const ContactStep<Real>& step);

/// Sets the time and speed of each contact's bounce in the substep, once the bodies' accelerations are known.
/// Returns false if nothing bounces.
///
/// A point has separation s and approaches at u with acceleration a. Its impact speed is c = sqrt(u^2 + 2 a
/// s), after t = 2 s / (u + c). From then on it moves freely: at the end of the substep it separates at e c -
/// a (h - t). With e = 1 that conserves the energy c^2 / 2 for any h.
template <class Real>
bool schedule_impacts(const SolverBody<Real>* motion, std::span<RestitutionContact<Real>> bounces,
                      const ContactStep<Real>& step);

/// Disables, before any iteration, contacts that will bounce but stay open in this substep. The solver would
/// slow them, and the momentum passed on to other bodies could not be recovered.
template <class Real>
void let_pass(std::span<RestitutionContact<Real>> bounces);

/// Enables the contacts again that `let_pass` disabled. Called after relax_contacts.
template <class Real>
void hold_again(std::span<RestitutionContact<Real>> bounces);

}  // namespace plumb
