#pragma once

#include <algorithm>

#include "engine/world/joint_solver/joint_constraint.h"
#include "engine/world/joint_solver/joint_hinge.h"

namespace plumb {

/// Compares how far rigid rows and limits of a joint are open with the way that a body makes at the joint
/// when it turns by `share`, rad: that is `share` times its radius of gyration about the joint. For angles it
/// is `share` itself. With Lanes, of several joints side by side.
template <class Number>
struct JointOpening {
  const JointVelocities<Number>& v;
  Scalar<Number> share = 0;
  Number most = -1;  ///< positive if a row is open by more than that

  [[gnu::always_inline]] void add(Number error_squared, Number linear_a, Number angular_a, Number linear_b,
                                  Number angular_b) {
    using std::max;
    const Number least = share * share;
    most = max(most, error_squared * v.i_a - least * (v.m_a * linear_a + v.i_a * angular_a));
    most = max(most, error_squared * v.i_b - least * (v.m_b * linear_b + v.i_b * angular_b));
  }
  [[gnu::always_inline]] void rigid(const JointRow<Number>& row, Number error) {
    add(error * error, length_squared(row.linear_a), row.angular_a * row.angular_a,
        length_squared(row.linear_b), row.angular_b * row.angular_b);
  }
  [[gnu::always_inline]] void rigid(Vec2<Number> gap, Vec2<Number> arm_a, Vec2<Number> arm_b) {
    add(length_squared(gap), 1, length_squared(arm_a), 1, length_squared(arm_b));
  }
  template <bool kAngular>
  [[gnu::always_inline]] void add(const JointCoordinate<Number, kAngular>& coordinate,
                                  const JointRow<Number>& row, Number q) {
    using std::min;
    for (int i = 0; i < coordinate.count; ++i) {
      const SolverRule<Number>& rule = coordinate.rule[i];
      const Number error = rule.sign * (q - rule.origin);
      if (rule.role == RowRole::Rigid) rigid(row, error);
      if (rule.role == RowRole::Limit) rigid(row, min(error, Number(0)));
    }
  }
};

/// Returns a positive number if a rigid row or limit of the joint is open, at these poses, by more than
/// `share` allows.
template <class Number>
[[gnu::always_inline]] inline Number joint_opening(const HingeConstraint<Number>& hinge,
                                                   const JointMotion<Number>& now,
                                                   const JointVelocities<Number>& v, Scalar<Number> share) {
  const HingeArms<Number> arms =
      hinge_arms(hinge.offset, now.moved_a, now.moved_b, rotated(now.rotation_a, hinge.anchor_a),
                 rotated(now.rotation_b, hinge.anchor_b));
  JointOpening<Number> opening{v, share};
  opening.rigid(arms.gap, arms.a, arms.b);
  return opening.most;
}

template <class Number, template <class> class Kind>
[[gnu::always_inline]] inline Number joint_opening(const JointConstraint<Number, Kind>& joint,
                                                   const JointMotion<Number>& now,
                                                   const JointVelocities<Number>& v, Scalar<Number> share) {
  using Constraint = JointConstraint<Number, Kind>;
  const JointPose<Number> at = joint.pose(now);
  JointRows<Number> rows;
  joint.kind.evaluate(at, rows);
  JointOpening<Number> opening{v, share};
  if constexpr (Kind<Number>::kTurn) opening.add(joint.turn, {{}, {}, -1, 1}, at.angle);
  for (int i = 0; i < Constraint::kAxial; ++i)
    opening.add(joint.axial[i], rows.axial[i], rows.axial[i].residual);
  for (int i = 0; i < Constraint::kBlock; ++i) opening.rigid(rows.block[i], rows.block[i].residual);
  if constexpr (Kind<Number>::kPoint)
    if (joint.point.rigid()) opening.rigid(rows.point.gap, rows.point.arm_a, rows.point.arm_b);
  return opening.most;
}

}  // namespace plumb
