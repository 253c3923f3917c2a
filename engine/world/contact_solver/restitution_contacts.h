#pragma once

#include <algorithm>
#include <span>

#include "engine/world/contact_solver/contact_constraint.h"
#include "engine/world/contact_solver/contact_step.h"

namespace plumb {

/// State of a contact that may bounce in the substep: one with restitution, or two discs that approach each
/// other.
template <class Real>
struct RestitutionContact {
  ContactConstraint<Real>* contact = nullptr;
  Real start_velocity[2] = {};  ///< m/s, velocity along the normal at the start of the substep
  Real end_speed[2] = {};       ///< m/s, separating speed of the points at the end of the substep
  bool has_impact[2] = {};      ///< fast enough to bounce, and in this substep
  bool impact_pending = false;  ///< fast enough to bounce, but in a later substep
  bool deferred = false;        ///< disabled in this substep
  Real radius_sum = 0;          ///< m, of two separated discs with centred shapes; else 0
  Real saved_masses[5] = {};    ///< of the contact, while it is disabled
  Vec2<Real> centre_offset{};   ///< m, between the discs' centres (a to b), at the start of the step
};

/// Returns the velocity of a contact point along the normal, m/s; negative: closing.
template <class Real>
Real velocity_along_normal(const SolverBody<Real>* motion, const ContactConstraint<Real>& c, int i) {
  const SolverBody<Real>&a = motion[c.body_a], &b = motion[c.body_b];
  return dot(c.normal, b.velocity - a.velocity) +
         (c.arm_b[i] * b.angular_velocity - c.arm_a[i] * a.angular_velocity);
}

/// Records the normal velocity of an impact: the fastest approach of the step.
template <class Real>
void record_approach(ContactConstraint<Real>& c, int i, Real rate) {
  const bool first = c.max_normal_impulse[i] == 0;
  c.approach[i] = first ? rate : std::min(c.approach[i], rate);
}

/// Sets the normal of two separated discs to that at their impact between `from` and `h`, or else at their
/// closest approach. With p the vector between the centres and v its rate, the impact is at |p + v t| = R.
/// The normal rotates until then; the current one would deflect the discs by that angle. Times before `from`
/// are excluded: after an impact at `from` that leaves the discs sliding, t = `from` is a double root, and
/// rounding could give an earlier root, at which they still approach.
template <class Real>
void update_circle_normal(const SolverBody<Real>* motion, RestitutionContact<Real>& bounce, Real h,
                          Real from);

// The functions below treat each contact separately: threads may share them.

/// Records the normal velocities at the start of the substep. Clears the impulses of contacts that separate
/// after a bounce, which must not be warm started. Returns true if any of these had an impulse.
template <class Real>
bool record_approaches(const SolverBody<Real>* motion, std::span<RestitutionContact<Real>> bounces,
                       const ContactStep<Real>& step);

/// Finds the contacts with impacts in the substep and their rebound speeds, once the bodies' accelerations
/// are known. Returns false if there are none.
///
/// A point at the separation s approaches at u with the acceleration a. Its impact speed is c = sqrt(u^2 + 2
/// a s), after t = 2 s / (u + c). From then on it moves freely: at the end of the substep it separates at e c
/// - a (h - t). With e = 1 this conserves the energy c^2 / 2 for any h.
template <class Real>
bool schedule_impacts(const SolverBody<Real>* motion, std::span<RestitutionContact<Real>> bounces,
                      const ContactStep<Real>& step);

/// Disables, before any iteration, contacts that will bounce but stay open in this substep. Otherwise the
/// solver would slow them down, and the momentum passed on to other bodies could not be recovered.
template <class Real>
void defer_impacts(std::span<RestitutionContact<Real>> bounces);

/// Enables the contacts that `defer_impacts` disabled. To be called after the relaxation.
template <class Real>
void restore_deferred(std::span<RestitutionContact<Real>> bounces);

}  // namespace plumb
