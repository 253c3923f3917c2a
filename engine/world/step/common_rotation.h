#pragma once

#include <cmath>

#include "engine/math/small_rotation.h"
#include "engine/world/ablation/ablation.h"
#include "engine/world/state/contact_setup.h"

/// The rotation that two bodies have in common, as on a carousel or in a drum. It turns their contact's
/// normal and arms within a step, by far more than they move relative to each other.
namespace plumb {

/// rad, largest common rotation in half a step: beyond it no plane follows the contact through the step, and
/// bodies that spin so fast touch for an instant. With 1 a spinning body left a closed room in 1 of 3,000.
inline constexpr double kMaxCommonRotation = 0.25;

/// Returns the rotation that two bodies have in common in a time, rad: both spin, and b circles a's centre of
/// mass, at no less than this rate. Zero if the directions differ: discs that roll over each other spin, but
/// their normal follows the line between their centres.
template <class Real>
Real common_rotation(const WorldData<Real>& w, const ContactRecord& contact, Vec2<Real> a_to_b, Real time) {
  if (!enabled(Switch::RidingContacts)) return 0;
  const SolverBody<Real>&a = w.motion[contact.body_a], &b = w.motion[contact.body_b];
  if (!(a.angular_velocity * b.angular_velocity > 0)) return 0;
  const Real spin =
      std::abs(a.angular_velocity) < std::abs(b.angular_velocity) ? a.angular_velocity : b.angular_velocity;
  const Real moment = cross(a_to_b, b.velocity - a.velocity), square = dot(a_to_b, a_to_b);
  if (!(moment * spin > 0)) return 0;
  const Real rotation = time * (std::abs(moment) < std::abs(spin) * square ? moment / square : spin);
  return std::abs(rotation) > Real(kMaxCommonRotation) ? Real(0) : rotation;
}

/// Prepares a contact as it is halfway through the bodies' common rotation, with the present separations. On
/// a wheel of radius r, that turns by x in a step, the plane of the step's start would let a body sink by
/// r x^2 / 2 in each step. New impulses are written to `impulse`.
template <class Real>
void prepare_rotating_contact(const WorldData<Real>& w, const ContactRecord& contact,
                              const ContactManifold<Real>& manifold, Real dt, ContactConstraint<Real>& c,
                              Real (&impulse)[2]) {
  const Vec2<Real> a_to_b = centres_a_to_b(w, contact);
  const Real rotation = common_rotation(w, contact, a_to_b, Real(0.5) * dt);
  const Rotation<Real> q = w.rotation[contact.body_a];
  if (rotation == 0) return prepare_contact(w, contact, manifold, q, a_to_b, c, impulse);
  prepare_contact(w, contact, manifold, rotated_by(q, rotation),
                  rotated_by(Rotation<Real>{1, 0}, rotation) * a_to_b, c, impulse);
}

}  // namespace plumb
