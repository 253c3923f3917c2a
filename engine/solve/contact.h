#pragma once

#include <cstdint>
#include <span>

#include "engine/collide/broad_phase.h"
#include "engine/collide/manifold.h"
#include "engine/solve/bodies.h"

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
  Real lower_bound = 0;                    ///< m/s: the pass keeps the normal velocity above it
  ContactImpulse<Real> hold{};             ///< of the pass before the bodies move
  ContactImpulse<Real> relax{};  ///< of the pass after; the last pass's is the next one's first guess
  Vec2<Real> local{};            ///< m, of two boxes: the point in the incident body's frame
  std::uint32_t feature = 0;
  bool in_pass = false;
};

/// What a pair of shapes does to each other.
template <class Real>
struct Contact {
  PairKey pair = 0;
  int a = 0, b = 0;  ///< bodies
  Real inverse_mass_a = 0, inverse_mass_b = 0, inverse_inertia_a = 0, inverse_inertia_b = 0;
  Vec2<Real> normal{};  ///< unit, from a to b
  Real friction = 0, restitution = 0;
  Real reach = 0;               ///< m, of the smaller shape: the contact's own scale of length
  int count = 0;                ///< points in use
  bool two_boxes = false;       ///< its points are followed between detections, not found anew
  bool reference_is_b = false;  ///< of two boxes: whose face gave the normal
  bool impact = false;          ///< bodies met in this substep; its impulses are no guess for the next
  bool bounced = false;         ///< the impact stage has dealt with it in this substep
  bool placed = false;          ///< normal and arms belong to the bodies' present poses
  Vec2<Real> local_normal{};    ///< of two boxes: out of the reference face, in its body's frame
  Real face_offset = 0;         ///< m, of that face from its body's centre of mass, along it
  ContactPoint<Real> points[2];
};

/// Relative velocity of b against a at the point.
template <class Real>
Vec2<Real> relative_velocity(const ContactPoint<Real>& point, const Twist<Real>& a, const Twist<Real>& b) {
  return velocity_at(b, point.arm_b) - velocity_at(a, point.arm_a);
}

/// Finds the contact's points at the given poses; impulses of points that were there before stay with them.
/// Points farther apart than `reach` are left out.
template <class Real>
void detect(Contact<Real>& contact, std::span<const SolidShape<Real>> shapes, const Pose<Real>& pose_a,
            const Pose<Real>& pose_b, Real reach);

/// Moves normal, arms and separations along with the bodies: circles are looked at anew, the corners of boxes
/// stay the corners that they were.
template <class Real>
void follow(Contact<Real>& contact, std::span<const SolidShape<Real>> shapes, const Pose<Real>& pose_a,
            const Pose<Real>& pose_b);

/// Sets the points' effective masses: 1/m = n.(M^-1 n), with the arms' part (r x n)^2 / I.
template <class Real>
void weigh(Contact<Real>& contact);

}  // namespace plumb
