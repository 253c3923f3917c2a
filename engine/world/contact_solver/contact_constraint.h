#pragma once

#include <cstdint>

#include "engine/math/pose.h"

namespace plumb {

/// Softness class of a contact.
enum class ContactHardness : std::uint8_t {
  Soft,        ///< between dynamic bodies
  Stiff,       ///< against a static or kinematic body
  Rigid,       ///< solved by the direct solver
  Driven,      ///< against a kinematic body that moves: it yields (solvers/driven_contacts.h)
  DrivenRigid  ///< the same, solved by the direct solver
};

/// Reasons to record a contact's approach velocity and largest impulses.
enum class ImpactTracking : std::uint8_t {
  Off,      ///< nothing is recorded
  Reports,  ///< hit events or the user's hook need it
  Motion,   ///< it may bounce, or does not touch yet
};

/// A contact at one or two points: manifold and constraint in one, kept from step to step. It is rebuilt only
/// when the bodies have moved relative to each other by more than `recycle_budget` (manifold recycling).
/// Until then the separations are updated to first order, as the solver does within a step.
///
/// With n the normal, t = (n.y, -n.x) the tangent and r the arm from a centre of mass, the velocity along n
/// is n.(vB - vA) + (rB x n) wB - (rA x n) wA, along t likewise. Both points lie on one line along t, so one
/// friction row serves both.
template <class Real>
struct ContactConstraint {
  int body_a = 0, body_b = 0;
  Vec2<Real> normal{};                    ///< unit, from a to b
  Real arm_a[2] = {}, arm_tangent_a = 0;  ///< m, r x n of each point, r x t half-way between them
  Real arm_b[2] = {}, arm_tangent_b = 0;
  Real separation[2] = {};          ///< m, at the start of the step
  Real current_separation[2] = {};  ///< m, updated in each substep
  Real normal_impulse[2] = {};      ///< N s, of the last substep
  Real load_estimate[2] = {};       ///< N s, low-pass filtered normal impulse
  Real tangent_impulse = 0;         ///< N s
  /// kg: effective mass of each point alone, and the inverse of the 2 x 2 matrix K = J M^-1 J^T of both
  /// points. With one point the inverse is that point's mass, and the rest is 0.
  Real mass[2] = {}, inverse_pp = 0, inverse_pq = 0, inverse_qq = 0;
  Real k_pq = 0;                 ///< 1/kg, K's entry between the points
  Real tangent_mass = 0;         ///< kg
  Real friction = 0;             ///< Coulomb's coefficient
  Real depenetration_speed = 0;  ///< m/s, maximum at which overlaps are removed
  Real surface_speed = 0;        ///< m/s, target relative velocity along t, by friction
  ContactHardness hardness = ContactHardness::Soft;
  std::uint8_t count = 0;  ///< points in use
  bool touching = false;   ///< as found at the start of a step; events may have reported it earlier
  /// Reason to record `approach`, `max_normal_impulse` and `step_impulse`. The motion uses them only if it is
  /// itself the reason, so that reports do not change it.
  ImpactTracking tracking = ImpactTracking::Off;

  // Data that the solver's passes do not need.
  Real restitution = 0;             ///< Newton's coefficient
  Real rolling_arm = 0;             ///< m: the rolling resistance torque is this times the normal force
  Real rolling_impulse = 0;         ///< N m s, of the last substep
  Real max_normal_impulse[2] = {};  ///< N s, largest normal impulse of the substeps
  Real step_impulse = 0;            ///< N s, sum of the normal impulses of the step, if tracked
  Real approach[2] = {};            ///< m/s, velocity along n at the start of the step, or at impact
  Real recycle_budget = 0;          ///< m, relative motion left until the manifold is rebuilt
  int contact = 0;                  ///< index of its record
  std::uint16_t features[2] = {};
  /// Locked axes of the bodies (locked_axes.h), none if a body has both locked, and what they do to friction.
  std::uint8_t locks = 0;
};

/// Compliance of driven contacts to what their impulse exceeds a load, as a fraction of their mobility. A
/// body that is pressed against one that does not give way slips out at up to 1 / (2 sqrt(kDrivenCompliance))
/// = 2.2 times the speed of the press. Of 300 piles of one to five planks under a turning press, at 16
/// substeps, 2 exceed 3 times the speed of its tip and of a fall, up to 3.7 times; with 0.01 10, up to 24
/// times; with 0.1 2, up to 7.5 times.
inline constexpr double kDrivenCompliance = 0.05;
/// The same as a fraction of the excess of a rigid solution.
inline constexpr double kDrivenYield = kDrivenCompliance / (1 + kDrivenCompliance);

/// Returns true if a contact is solved by the direct solver.
template <class Contact>
bool is_rigid(const Contact& c) {
  return c.hardness == ContactHardness::Rigid || c.hardness == ContactHardness::DrivenRigid;
}
/// Returns true if a contact is of a kinematic body that moves, and yields.
template <class Contact>
bool is_driven(const Contact& c) {
  return c.hardness >= ContactHardness::Driven;
}

/// Returns true if a contact has had a normal impulse in the step, as far as the motion depends on it. A
/// contact without restitution that touched at the start has one at the end of the step if it has had any.
template <class Real>
bool has_pressed(const ContactConstraint<Real>& c) {
  if (c.normal_impulse[0] > 0 || c.normal_impulse[1] > 0) return true;
  return c.tracking == ImpactTracking::Motion && (c.max_normal_impulse[0] > 0 || c.max_normal_impulse[1] > 0);
}

}  // namespace plumb
