#pragma once

#include "engine/world/contact_solver/velocity_change.h"
#include "engine/world/joint_solver/joint_constraint.h"

/// Position-based joint solver. Within a substep a body's velocity is its displacement since the substep's
/// start over h. A projection by dx therefore changes the velocity by dx / h at once. The rules of a joint
/// are then the same as for velocities, with the residual at the substep's start: C(x) - h J v. Rigid rows
/// get C(x + dx) = 0 to first order. A spring gets lambda = -(k C + c dC/dt) at the end, which is a
/// compliance 1 / k (Macklin, Mueller and Chentanez, XPBD, 2016, eq. 18 and 26). Motors, limits and bounds
/// apply unchanged to the substep's impulse.
namespace plumb {

/// Writes back velocities and the corresponding positions.
template <class Real>
void store_projected(const JointVelocities<Real>& v, const JointVelocities<Real>& before, SolverBody<Real>& a,
                     SolverBody<Real>& b, Rotation<Real>& rotation_a, Rotation<Real>& rotation_b, Real h) {
  v.store(a, b);
  if (v.m_a + v.i_a > 0) move_by_velocity_change(a, rotation_a, before.v_a, before.w_a, h);
  if (v.m_b + v.i_b > 0) move_by_velocity_change(b, rotation_b, before.v_b, before.w_b, h);
}

/// Clears the joint's impulses at the start of a substep.
template <class Real, template <class> class Kind>
void begin_projection(JointConstraint<Real, Kind>& joint, const SolverBodies<Real>& bodies,
                      const JointStep<Real>& step) {
  using Constraint = JointConstraint<Real, Kind>;
  joint.scale(0);
  // A ratchet advances at reached positions, not at predicted ones.
  if constexpr (Constraint::kRatchet) {
    joint.evaluate(motion_of(bodies, joint.a, joint.b), velocities_of(bodies, joint), step,
                   JointTime::Between);
  }
}

/// Moves the two bodies such that the joint's rules hold at the new positions.
template <class Real, template <class> class Kind>
void project(JointConstraint<Real, Kind>& joint, const SolverBodies<Real>& bodies, Rotation<Real>* rotation,
             const JointStep<Real>& step) {
  using Constraint = JointConstraint<Real, Kind>;
  SolverBody<Real>&a = bodies.motion[joint.a], &b = bodies.motion[joint.b];
  JointVelocities<Real> v = velocities_of(bodies, joint);
  const JointVelocities<Real> before = v;
  const Real h = step.h;

  const JointPose<Real> at = joint.pose(bodies);
  joint.store_angles(motion_of(bodies, joint.a, joint.b));
  JointRows<Real> rows;
  joint.kind.evaluate(at, rows);
  if constexpr (Constraint::kHasRows) joint.arm_b = rows.arm_b;
  JointPose<Real> start = at;
  start.angle -= h * (v.w_b - v.w_a);
  if constexpr (Constraint::kBlock > 0) {
    for (int i = 0; i < Constraint::kBlock; ++i) {
      joint.block.row[i] = rows.block[i];
      joint.block.row[i].residual -= h * v.along(rows.block[i]);
    }
    joint.block.factorise(v);
  }
  for (int i = 0; i < Constraint::kAxial; ++i) rows.axial[i].residual -= h * v.along(rows.axial[i]);
  if constexpr (Kind<Real>::kPoint) rows.point.gap -= h * v.at(rows.point.arm_a, rows.point.arm_b);
  joint.evaluate_single(start, rows, v, step, {});
  joint.solve_coordinates(v, step, kSolve, Real(1));
  store_projected(v, before, a, b, rotation[joint.a], rotation[joint.b], h);
}

}  // namespace plumb
