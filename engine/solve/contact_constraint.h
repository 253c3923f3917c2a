#pragma once

#include <cstdint>

#include "engine/math/pose.h"

namespace plumb {

/// One point of a contact as the solver sees it. With n the normal, t = (n.y, -n.x) the tangent and r the arm
/// from a centre of mass, the velocity along n is n.(vB - vA) + (rB x n) wB - (rA x n) wA, along t likewise.
template <class Real>
struct ContactPoint {
  Real arm_normal_a = 0, arm_normal_b = 0;    ///< r x n, m
  Real arm_tangent_a = 0, arm_tangent_b = 0;  ///< r x t, m
  Real separation = 0;                        ///< m, at the step's start
  Real normal_mass = 0, tangent_mass = 0;     ///< kg, effective
  Real normal_impulse = 0;                    ///< N s, of the last substep
  Real tangent_impulse = 0;                   ///< N s, of the last substep
  Real peak_impulse = 0;                      ///< N s, the largest normal impulse of the step's substeps
  Real approach = 0;                          ///< m/s, velocity along n at the step's start
};

/// How a contact answers an overlap.
enum class ContactHardness : std::uint8_t {
  Soft,   ///< between bodies that give way
  Stiff,  ///< against one that does not
  Rigid,  ///< held by a direct solution
};

/// The touching of two shapes: manifold and constraint in one, kept from step to step. It is rebuilt only
/// when the bodies have moved relative to each other by more than `travel_left`; until then the separations
/// are carried on to first order, as the solver does within a step.
template <class Real>
struct ContactConstraint {
  int body_a = 0, body_b = 0;
  Vec2<Real> normal{};  ///< unit, from a to b
  ContactPoint<Real> points[2];
  Real friction = 0;         ///< Coulomb's coefficient
  Real restitution = 0;      ///< Newton's coefficient
  Real rolling_arm = 0;      ///< m: the torque that resists rolling is this times the normal force
  Real rolling_impulse = 0;  ///< N m s, of the last substep
  Real surface_speed = 0;    ///< m/s, relative velocity along t that friction drives to
  Real push_speed = 0;       ///< m/s, fastest push out of an overlap
  Real travel_left = 0;      ///< m
  int contact = 0;           ///< its record
  std::uint16_t features[2] = {0, 0};
  std::uint8_t count = 0;  ///< points in use
  ContactHardness hardness = ContactHardness::Soft;
  bool touching = false;  ///< as events tell it
};

}  // namespace plumb
