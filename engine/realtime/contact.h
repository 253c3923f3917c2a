#pragma once

#include <cstdint>
#include <span>

#include "engine/realtime/bodies.h"
#include "engine/realtime/broad_phase.h"
#include "engine/realtime/manifold.h"

namespace plumb {

/// Impulse along a contact's normal and tangent, N s.
template <class Real>
struct ContactImpulse {
  Real normal = 0, friction = 0;
};

/// One point of a contact: two constraints, along the normal and along the tangent.
template <class Real>
struct ContactPoint {
  Vec2<Real> arm_a{}, arm_b{};             ///< m, from the centres of mass
  Real separation = 0;                     ///< m
  Real normal_mass = 0, tangent_mass = 0;  ///< kg, 1 / (J M^-1 J^T)
  Real lower_bound = 0;                    ///< m/s: lower bound of the normal velocity in the pass
  ContactImpulse<Real> hold{};             ///< of the pass before the bodies move
  ContactImpulse<Real> relax{};  ///< of the pass after they move; the last pass warm-starts the next one
  Vec2<Real> local{};            ///< m, of two boxes: the point in the incident body's frame
  std::uint32_t feature = 0;
  bool in_pass = false;
};

/// A contact between two shapes.
template <class Real>
struct Contact {
  PairKey pair = 0;
  int a = 0, b = 0;  ///< bodies
  Real inverse_mass_a = 0, inverse_mass_b = 0, inverse_inertia_a = 0, inverse_inertia_b = 0;
  Vec2<Real> normal{};  ///< unit, from a to b
  Real friction = 0, restitution = 0;
  Real reach = 0;               ///< m, of the smaller shape: the contact's length scale
  int count = 0;                ///< points in use
  bool two_boxes = false;       ///< points are tracked between detections, not found anew
  bool reference_is_b = false;  ///< of two boxes: the normal is that of b's face
  bool impact = false;  ///< the bodies had an impact in this substep; its impulses do not warm-start the next
  bool bounced = false;       ///< the impact stage has dealt with it in this substep
  bool placed = false;        ///< normal and arms are those of the bodies' present poses
  Vec2<Real> local_normal{};  ///< of two boxes: outward normal of the reference face, in its body's frame
  Real face_offset = 0;       ///< m, distance of that face from its body's centre of mass along the normal
  ContactPoint<Real> points[2];
};

/// Returns the velocity of b relative to a at the point.
template <class Real>
Vec2<Real> relative_velocity(const ContactPoint<Real>& point, const Twist<Real>& a, const Twist<Real>& b) {
  return velocity_at(b, point.arm_b) - velocity_at(a, point.arm_a);
}

/// Finds the contact's points at the given poses and keeps the impulses of points that persist. Omits points
/// farther apart than `reach`.
template <class Real>
void detect(Contact<Real>& contact, std::span<const SolidShape<Real>> shapes, const Pose<Real>& pose_a,
            const Pose<Real>& pose_b, Real reach);

/// Updates normal, arms and separations from the bodies' poses. Circles are recomputed; of boxes the contact
/// points stay the same corners.
template <class Real>
void follow(Contact<Real>& contact, std::span<const SolidShape<Real>> shapes, const Pose<Real>& pose_a,
            const Pose<Real>& pose_b);

/// Computes the points' effective masses: 1/m = n.(M^-1 n), plus (r x n)^2 / I of the arms.
template <class Real>
void weigh(Contact<Real>& contact);

}  // namespace plumb
