#pragma once

#include <cstdint>

#include "engine/math/pose.h"

namespace plumb {

/// How a contact answers an overlap.
enum class ContactHardness : std::uint8_t {
  Soft,   ///< between bodies that give way
  Stiff,  ///< against one that does not
  Rigid,  ///< held by a direct solution
};

/// The touching of two shapes at one or two points: manifold and constraint in one, kept from step to step.
/// It is rebuilt only when the bodies have moved relative to each other by more than `travel_left`; until
/// then the separations are carried on to first order, as the solver does within a step.
///
/// With n the normal, t = (n.y, -n.x) the tangent and r the arm from a centre of mass, the velocity along n
/// is n.(vB - vA) + (rB x n) wB - (rA x n) wA, along t likewise. Both points lie on one line along t, so that
/// a single row of friction serves them.
template <class Real>
struct ContactConstraint {
  int body_a = 0, body_b = 0;
  Vec2<Real> normal{};                    ///< unit, from a to b
  Real arm_a[2] = {}, arm_tangent_a = 0;  ///< m, r x n of each point, r x t half-way between them
  Real arm_b[2] = {}, arm_tangent_b = 0;
  Real separation[2] = {};        ///< m, at the step's start
  Real now[2] = {};               ///< m, the separations as the substeps carry them on
  Real normal_impulse[2] = {};    ///< N s, of the last substep
  Real expected_impulse[2] = {};  ///< N s, most of what the normal impulses have been for some time
  Real tangent_impulse = 0;       ///< N s
  /// kg: each point's effective mass alone, and the inverse of both points' K = J M^-1 J^T. With one point
  /// the inverse is its mass, and the rest is 0.
  Real mass[2] = {}, inverse_pp = 0, inverse_pq = 0, inverse_qq = 0;
  Real between = 0;        ///< 1/kg, K's entry between the points
  Real tangent_mass = 0;   ///< kg
  Real friction = 0;       ///< Coulomb's coefficient
  Real push_speed = 0;     ///< m/s, fastest push out of an overlap
  Real surface_speed = 0;  ///< m/s, relative velocity along t that friction drives to
  ContactHardness hardness = ContactHardness::Soft;
  std::uint8_t count = 0;  ///< points in use
  bool touching = false;   ///< as events tell it
  bool watched = false;  ///< approach and peaks are noted: it may bounce, does not touch yet, or is reported

  // What passes of the solver do not need.
  Real restitution = 0;       ///< Newton's coefficient
  Real rolling_arm = 0;       ///< m: the torque that resists rolling is this times the normal force
  Real rolling_impulse = 0;   ///< N m s, of the last substep
  Real peak_impulse[2] = {};  ///< N s, the largest normal impulse of the step's substeps
  Real approach[2] = {};      ///< m/s, velocity along n at the step's start, or as it was struck
  Real travel_left = 0;       ///< m
  int contact = 0;            ///< its record
  std::uint16_t features[2] = {};
};

}  // namespace plumb
