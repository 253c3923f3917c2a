#include <limits>

#include "engine/solve/joint_parts.h"

namespace plumb {
namespace {

template <class Real>
void add_point(const Vec2<Real>& arm_a, const Vec2<Real>& arm_b, const Vec2<Real>& bias, Vec2<Real>& impulse,
               RigidRow<Real>* rows, int& count) {
  const auto row = [&](Vec2<Real> n) { return JointRow<Real>{-n, n, -cross(arm_a, n), cross(arm_b, n), 0}; };
  rows[count++] = {row({1, 0}), bias.x, &impulse.x};
  rows[count++] = {row({0, 1}), bias.y, &impulse.y};
}

template <class Real>
void add_rows(HingeConstraint<Real>& hinge, const JointStep<Real>&, RigidRow<Real>* rows, int& count) {
  add_point(hinge.arm_a, hinge.arm_b, hinge.bias, hinge.impulse, rows, count);
}

template <class Real, template <class> class Kind>
void add_rows(JointConstraint<Real, Kind>& joint, const JointStep<Real>& step, RigidRow<Real>* rows,
              int& count) {
  using Constraint = JointConstraint<Real, Kind>;
  constexpr Real kUnbounded = std::numeric_limits<Real>::infinity();
  if constexpr (Constraint::kOneBody || Constraint::kPulley) {
    return;  // what pulls at points of the world has springs or bounds
  } else {
    for (int i = 0; i < Constraint::kAxial; ++i) {
      auto& coordinate = joint.axial[i];
      for (int k = 0; k < coordinate.count && count < kMostRigidRows; ++k) {
        SolverRule<Real>& rule = coordinate.rule[k];
        if (rule.role != RowRole::Rigid || rule.sign != 1) continue;
        rows[count++] = {coordinate.row, step.softness.bias_rate * (coordinate.row.residual - rule.origin),
                         &rule.impulse};
      }
    }
    if constexpr (Constraint::kBlock > 0) {
      for (int i = 0; i < Constraint::kBlock; ++i) {
        const JointRow<Real>& row = joint.block.row[i];
        rows[count++] = {row, step.softness.bias_rate * row.residual, &joint.block.impulse[i]};
      }
    }
    if constexpr (Kind<Real>::kPoint) {
      if (joint.point.rule.role != RowRole::Rigid || joint.point.rule.most < kUnbounded) return;
      const AnchorPoint<Real>& at = joint.point.point;
      add_point(at.arm_a, at.arm_b, step.softness.bias_rate * at.gap, joint.point.impulse, rows, count);
    }
  }
}

}  // namespace

template <class Real>
int JointSet<Real>::rigid_rows(int joint, const JointStep<Real>& step,
                               RigidRow<Real> (&rows)[kMostRigidRows]) {
  int count = 0;
  parts_->at(joint, [&](auto& constraint) { add_rows(constraint, step, rows, count); });
  return count;
}

template int JointSet<float>::rigid_rows(int, const JointStep<float>&, RigidRow<float> (&)[kMostRigidRows]);
template int JointSet<double>::rigid_rows(int, const JointStep<double>&,
                                          RigidRow<double> (&)[kMostRigidRows]);

}  // namespace plumb
