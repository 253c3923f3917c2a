#pragma once

#include <algorithm>
#include <vector>

#include "engine/solve/soft_contacts.h"

namespace plumb {

/// A contact whose restitution is not 0, or of discs that approach fast, and when and how it bounces in the
/// substep.
template <class Real>
struct Bounce {
  ContactConstraint<Real>* contact = nullptr;
  Real before[2] = {};  ///< m/s, velocity along the normal at the substep's start
  Real speed[2] = {};   ///< m/s, at which its points are to part at the substep's end
  bool strikes[2] = {};
  bool closes = false;   ///< fast enough to bounce
  bool passes = false;   ///< through this substep, to strike in a later one
  Real radii = 0;        ///< m, of two discs about their centres of mass that were apart; 0: of anything else
  Real masses[5] = {};   ///< of the contact, while it passes
  Vec2<Real> between{};  ///< m, from the one disc's centre to the other's, at the step's start
};

/// m/s, of a point of the contact along its normal; negative: closing.
template <class Real>
Real velocity_along_normal(const BodyMotion<Real>* motion, const ContactConstraint<Real>& c, int i) {
  const BodyMotion<Real>&a = motion[c.body_a], &b = motion[c.body_b];
  return dot(c.normal, b.velocity - a.velocity) +
         (c.arm_b[i] * b.angular_velocity - c.arm_a[i] * a.angular_velocity);
}

/// Notes how fast a point has been struck: the fastest time of a step.
template <class Real>
void note_approach(ContactConstraint<Real>& c, int i, Real rate) {
  const bool first = c.peak_impulse[i] == 0;
  c.approach[i] = first ? rate : std::min(c.approach[i], rate);
}

/// Turns the normal of two discs that are apart to where it will be when they touch within `h`, or else are
/// nearest to each other: with p from centre to centre and v its rate, |p + v t| = R. A normal of where they
/// are now would throw them aside by the angle that it turns on the way.
template <class Real>
void face(const BodyMotion<Real>* motion, Bounce<Real>& bounce, Real h);

/// Notes how fast points approach before anything acts. What parts after a bounce is not to be warm started:
/// whether there was an impulse of such.
template <class Real>
bool note_approaches(const BodyMotion<Real>* motion, std::vector<Bounce<Real>>& bounces,
                     const ContactStep<Real>& step);

/// Gives each bounce its place in the substep, once it is known what accelerates the bodies; false when
/// nothing bounces.
///
/// A point that is s open and closes at u with the acceleration a strikes with c = sqrt(u^2 + 2 a s) after
/// t = 2 s / (u + c). From there on it flies: at the substep's end it parts at e c - a (h - t). With e = 1
/// that keeps the energy c^2 / 2, whatever h is.
template <class Real>
bool place_bounces(const BodyMotion<Real>* motion, std::vector<Bounce<Real>>& bounces,
                   const ContactStep<Real>& step);

/// Before any sweep. What closes fast enough to bounce, but will still be open when the substep ends, is to
/// keep its speed: sweeps that slow it hand on what they take, and that cannot be taken back.
template <class Real>
void let_pass(std::vector<Bounce<Real>>& bounces);

/// After relax_contacts: what was let pass is held again.
template <class Real>
void hold_again(std::vector<Bounce<Real>>& bounces);

}  // namespace plumb
