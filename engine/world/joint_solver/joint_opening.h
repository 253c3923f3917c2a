#pragma once

#include "engine/world/joint_solver/joint_constraint.h"

namespace plumb {

/// Compares the gaps of rigid rows and limits of a joint with its link length: the radius of gyration about
/// the joint, of the body for which it is shorter. For a joint that is itself a link (rod, rope) it is at
/// least the joint's length. For angles the link length is 1. Takes no square root. With Lanes it handles
/// several joints side by side.
template <class Number>
struct JointOpening {
  const PairMobility<Number> p{};
  const Scalar<Number> tolerance = 0;  ///< fraction of the link by which a joint may be open
  Number excess = -1;                  ///< positive if a row is open by more than is allowed

  [[gnu::always_inline]] void add(Number error_squared, Number length, Number linear_a, Number angular_a,
                                  Number linear_b, Number angular_b) {
    using std::max, std::min;
    const Number least = tolerance * tolerance;
    const Number of_bodies = max(error_squared * p.i_a - least * (p.m_a * linear_a + p.i_a * angular_a),
                                 error_squared * p.i_b - least * (p.m_b * linear_b + p.i_b * angular_b));
    excess = max(excess, min(of_bodies, error_squared - least * (length * length)));
  }
  [[gnu::always_inline]] void rigid(const JointRow<Number>& row, Number error, Number length = 0) {
    add(error * error, length, length_squared(row.linear_a), row.angular_a * row.angular_a,
        length_squared(row.linear_b), row.angular_b * row.angular_b);
  }
  [[gnu::always_inline]] void rigid(const AnchorPoint<Number>& point) {
    add(length_squared(point.gap), 0, 1, length_squared(point.arm_a), 1, length_squared(point.arm_b));
  }
};

/// Returns a positive number if a rigid row of the joint, or a limit along an axis, was open by more than
/// a fraction `tolerance` of its link at the last evaluation. Reads the stored residuals, so that testing all
/// joints costs little. Limits of angles have a pass of their own (`project_angular_limits`).
template <class Number, template <class> class Kind>
[[gnu::always_inline]] inline Number joint_opening(const JointConstraint<Number, Kind>& joint,
                                                   const PairMobility<Number>& p, Scalar<Number> tolerance) {
  using Constraint = JointConstraint<Number, Kind>;
  using std::min;
  JointOpening<Number> opening{p, tolerance};
  for (int k = 0; k < Constraint::kAxial; ++k) {
    const auto& coordinate = joint.axial[k];
    for (int i = 0; i < coordinate.count; ++i) {
      const SolverRule<Number>& rule = coordinate.rule[i];
      const Number error = rule.sign * (coordinate.row.residual - rule.origin);
      const Number length = Kind<Number>::kLength ? rule.origin : Number(0);
      if (rule.role == RowRole::Rigid) opening.rigid(coordinate.row, error, length);
      if (rule.role == RowRole::Limit) opening.rigid(coordinate.row, min(error, Number(0)), length);
    }
  }
  if constexpr (Constraint::kBlock > 0)
    for (int i = 0; i < Constraint::kBlock; ++i)
      opening.rigid(joint.block.row[i], joint.block.row[i].residual);
  if constexpr (Kind<Number>::kPoint)
    if (joint.point.rigid()) opening.rigid(joint.point.point);
  return opening.excess;
}

}  // namespace plumb
