#pragma once

#include <limits>
#include <memory_resource>
#include <vector>

#include "engine/world/contact_solver/impact_propagation.h"
#include "engine/world/contact_solver/soft_contacts.h"
#include "engine/world/joint_solver/joint_set.h"
#include "engine/world/state/records.h"

namespace plumb {

/// External velocity change of a body in a substep, by forces and damping: v' = damping_factor v + velocity.
template <class Real>
struct VelocityIncrement {
  int body = 0;
  Vec2<Real> velocity{};                             ///< m/s, by forces, as far as damping leaves it
  Real spin = 0;                                     ///< rad/s, the same
  Real damping_factor = 1, spin_damping_factor = 1;  ///< of the velocities before
  bool locked_x = false, locked_y = false;
  bool in_tree = false;          ///< moved as part of its articulated body
  Vec2<Real> velocity_before{};  ///< m/s, after forces, before contact impulses of this substep. Before the
                                 ///< first: m, the displacement of the last step
  Real spin_before = 0;          ///< rad/s, the same; rad
};

/// A row whose position error is fed back, see solvers/error_feedback.h.
template <class Real>
struct FeedbackRow {
  int body_a = 0, body_b = 0;
  JointRow<Real> row{};
  Real target_speed = 0;  ///< m/s or rad/s, target along the row
  Real mass = 0, impulse = 0;
  Real compliance = 0;                                                        ///< 1/kg or 1/(kg m^2)
  Real min_impulse = 0, max_impulse = std::numeric_limits<Real>::infinity();  ///< bounds of the impulse
};

/// Data of the integration and of the solvers within a step.
template <class Real>
struct SolverScratch {
  explicit SolverScratch(std::pmr::memory_resource* memory) : impacts(memory) {}

  std::vector<VelocityIncrement<Real>> velocity_increments;  ///< of the awake bodies that move by substeps
  std::vector<BodyVelocity<Real>> start_velocities;          ///< their velocities at the start of the step
  std::vector<Real>
      warm_start_fraction;  ///< by body: fraction of the impulses from which iterations start; empty: 1
  std::vector<JointSolverRow<Real>> joint_rows;
  std::vector<FeedbackRow<Real>> feedback_rows;
  std::vector<BodyVelocity<Real>> feedback;  ///< by body
  std::vector<RestitutionContact<Real>> restitution_contacts;
  std::vector<Real> earlier_impulses;  ///< N s, of contacts and joints: state/impulse_memory.h
  std::vector<char> is_scalar;         ///< by contact: not solved in SIMD lanes
  SoftContacts<Real> soft_contacts;
  ImpactScratch<Real> impacts;
};

}  // namespace plumb
