#include <cmath>
#include <limits>
#include <type_traits>

#include "engine/solve/joint_parts.h"

namespace plumb {
namespace {

// Of the rows along x and y of a force that keeps its direction: F . r, from the other row's r x n.
template <class Real>
void set_turning(RigidRow<Real>& x, RigidRow<Real>& y) {
  x.turning_a = y.row.angular_a, x.turning_b = y.row.angular_b;
  y.turning_a = -x.row.angular_a, y.turning_b = -x.row.angular_b;
}

// Of a rod of `length` between anchors, whose direction n turns with them: -n . r - (n . r)^2 / length and
// -1 / length, n . r bounded by |r|. What ties the two bodies to each other is as large: twice the latter.
template <class Real>
void set_turning(RigidRow<Real>& row, Real length, Vec2<Real> anchor_a, Vec2<Real> anchor_b) {
  if (!(length > 0)) return;
  const Real a = std::sqrt(length_squared(anchor_a)), b = std::sqrt(length_squared(anchor_b));
  row.turning_a = -(a + 2 * a * a / length), row.turning_b = -(b + 2 * b * b / length);
  row.sliding = -2 / length;
}

template <class Real>
void add_point(const Vec2<Real>& arm_a, const Vec2<Real>& arm_b, const Vec2<Real>& gap, Vec2<Real>& impulse,
               RigidRow<Real>* rows, int& count) {
  const auto row = [&](Vec2<Real> n) { return JointRow<Real>{-n, n, -cross(arm_a, n), cross(arm_b, n), 0}; };
  rows[count++] = {row({1, 0}), gap.x, &impulse.x};
  rows[count++] = {row({0, 1}), gap.y, &impulse.y};
  set_turning(rows[count - 2], rows[count - 1]);
}

template <class Real>
void add_rows(HingeConstraint<Real>& hinge, RigidRow<Real>* rows, int& count) {
  add_point(hinge.arm_a, hinge.arm_b, hinge.gap, hinge.impulse, rows, count);
}

template <class Real, template <class> class Kind>
void add_rows(JointConstraint<Real, Kind>& joint, RigidRow<Real>* rows, int& count) {
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
        rows[count++] = {coordinate.row, coordinate.row.residual - rule.origin, &rule.impulse};
        if constexpr (std::is_same_v<Kind<Real>, DistanceRows<Real>>)
          set_turning(rows[count - 1], coordinate.row.residual, joint.kind.anchor_a, joint.kind.anchor_b);
      }
    }
    if constexpr (Constraint::kBlock > 0) {
      for (int i = 0; i < Constraint::kBlock; ++i) {
        const JointRow<Real>& row = joint.block.row[i];
        rows[count++] = {row, row.residual, &joint.block.impulse[i]};
      }
      if constexpr (std::is_same_v<Kind<Real>, WeldRows<Real>>) set_turning(rows[count - 2], rows[count - 1]);
    }
    if constexpr (Kind<Real>::kPoint) {
      if (joint.point.rule.role != RowRole::Rigid || joint.point.rule.most < kUnbounded) return;
      const AnchorPoint<Real>& at = joint.point.point;
      add_point(at.arm_a, at.arm_b, at.gap, joint.point.impulse, rows, count);
    }
  }
}

}  // namespace

template <class Real>
int JointSet<Real>::rigid_rows(int joint, RigidRow<Real> (&rows)[kMostRigidRows]) {
  int count = 0;
  parts_->at(joint, [&](auto& constraint) { add_rows(constraint, rows, count); });
  return count;
}

template <class Real>
bool JointSet<Real>::is_hinge(int joint) const {
  return parts_->slot(joint).form == kHinge;
}

template <class Real>
HeldHinge<Real> JointSet<Real>::hold(int joint) {
  const JointSlot& slot = parts_->slot(joint);
  const auto& definition = std::get<RevoluteDefinition>(slot.definition);
  HingeConstraint<Real>& hinge = std::get<kHinge>(parts_->store)[slot.colour][slot.index];
  hinge.held = hinge.alone = true;
  return {definition.anchor_a - slot.centre_a, definition.anchor_b - slot.centre_b, &hinge.impulse};
}

template <class Real>
void JointSet<Real>::let_go() {
  for (auto& list : std::get<kHinge>(parts_->store))
    for (HingeConstraint<Real>& hinge : list) hinge.held = false;
}

template bool JointSet<float>::is_hinge(int) const;
template bool JointSet<double>::is_hinge(int) const;
template HeldHinge<float> JointSet<float>::hold(int);
template HeldHinge<double> JointSet<double>::hold(int);
template void JointSet<float>::let_go();
template void JointSet<double>::let_go();
template int JointSet<float>::rigid_rows(int, RigidRow<float> (&)[kMostRigidRows]);
template int JointSet<double>::rigid_rows(int, RigidRow<double> (&)[kMostRigidRows]);

}  // namespace plumb
