#include <algorithm>

#include "engine/world/joint_solver/joint_parts.h"

namespace plumb {
namespace {

template <class Real>
struct RowList {
  std::vector<JointSolverRow<Real>>& rows;

  /// Appends a row. `length`: true if its coordinate is a length.
  void add(JointRow<Real> row, SolverRule<Real>& rule, bool length) const {
    JointSolverRow<Real> out{
        .row = row, .role = rule.role, .speed = rule.speed, .max_impulse = rule.max_impulse};
    if (length) out.length = rule.origin;
    out.row.residual = rule.sign * (row.residual - rule.origin);
    if (rule.sign < 0) {
      out.row.linear_a = -row.linear_a, out.row.linear_b = -row.linear_b;
      out.row.angular_a = -row.angular_a, out.row.angular_b = -row.angular_b;
    }
    out.impulse = &rule.impulse;
    if (rule.role == RowRole::Spring) out.rate = rule.spring.rate, out.compliance = rule.spring.compliance;
    rows.push_back(out);
  }

  template <bool kAngular>
  void add(const JointRow<Real>& row, JointCoordinate<Real, kAngular>& coordinate,
           bool length = false) const {
    for (int i = 0; i < coordinate.count; ++i) add(row, coordinate.rule[i], length);
  }

  void add_rigid(const JointRow<Real>& row, Real* impulse) const {
    rows.push_back({.row = row, .role = RowRole::Rigid, .impulse = impulse});
  }

  void add(const AnchorPoint<Real>& at, RigidPoint<Real>& point) const {
    add_rigid(at.plain_row({1, 0}), &point.impulse.x);
    add_rigid(at.plain_row({0, 1}), &point.impulse.y);
  }
  void add(const AnchorPoint<Real>& at, SoftPoint<Real>& point) const {
    for (const Vec2<Real> n : {Vec2<Real>{1, 0}, Vec2<Real>{0, 1}}) {
      JointSolverRow<Real> out{
          .row = at.plain_row(n), .role = point.rule.role, .max_impulse = point.rule.max_impulse};
      out.pair = n.y != 0;
      out.impulse = out.pair ? &point.impulse.y : &point.impulse.x;
      if (point.rule.role == RowRole::Spring)
        out.rate = point.rule.spring.rate, out.compliance = point.rule.spring.compliance;
      rows.push_back(out);
    }
  }
};

template <class Real, template <class> class Kind>
void add_rows(JointConstraint<Real, Kind>& joint, const SolverBodies<Real>& bodies,
              std::vector<JointSolverRow<Real>>& rows) {
  using Constraint = JointConstraint<Real, Kind>;
  const std::size_t first = rows.size();
  const RowList<Real> list{rows};
  const JointPose<Real> at = joint.pose(bodies);
  JointRows<Real> now;
  joint.kind.evaluate(at, now);
  if constexpr (Kind<Real>::kAngular) list.add(JointRow<Real>{{}, {}, -1, 1, at.angle}, joint.angular);
  for (int i = 0; i < Constraint::kAxial; ++i) list.add(now.axial[i], joint.axial[i], Kind<Real>::kLength);
  if constexpr (Constraint::kBlock > 0)
    for (int i = 0; i < Constraint::kBlock; ++i) list.add_rigid(now.block[i], &joint.block.impulse[i]);
  if constexpr (Kind<Real>::kPoint) list.add(now.point, joint.point);
  if constexpr (Constraint::kOneBody)
    for (std::size_t i = first; i < rows.size(); ++i) rows[i].row.linear_a = {}, rows[i].row.angular_a = 0;
}

}  // namespace

template <class Real>
void JointSet<Real>::solver_rows(int joint, const SolverBodies<Real>& bodies,
                                 std::vector<JointSolverRow<Real>>& rows) {
  parts_->at(joint, [&](auto& constraint) { add_rows(constraint, bodies, rows); });
}

template <class Real>
void JointSet<Real>::set_substep(int joint, Real h) {
  parts_->at(joint, [&]<template <class> class Kind>(JointConstraint<Real, Kind>& constraint) {
    using Constraint = JointConstraint<Real, Kind>;
    using Definition = typename Constraint::Definition;
    if (Constraint::kHasRules && constraint.known_h != h)
      constraint.set_substep(std::get<Definition>(parts_->slot(joint).definition), h);
  });
}

template <class Real>
int JointSet<Real>::bounded_rows(int joint) const {
  const auto is_bounded = [](const SolverRule<Real>& rule) {
    return rule.role == RowRole::Limit || rule.role == RowRole::Motor;
  };
  const auto bounded_of = [&](const auto& coordinate) {
    return static_cast<int>(std::count_if(coordinate.rule, coordinate.rule + coordinate.count, is_bounded));
  };
  return parts_->at(joint, [&]<template <class> class Kind>(const JointConstraint<Real, Kind>& constraint) {
    using Constraint = JointConstraint<Real, Kind>;
    int count = 0;
    if constexpr (Kind<Real>::kAngular) count += bounded_of(constraint.angular);
    for (const auto& coordinate : constraint.axial) count += bounded_of(coordinate);
    if constexpr (Constraint::kSoftPoint) count += is_bounded(constraint.point.rule) ? 2 : 0;
    return count;
  });
}

template void JointSet<float>::set_substep(int, float);
template void JointSet<double>::set_substep(int, double);
template int JointSet<float>::bounded_rows(int) const;
template int JointSet<double>::bounded_rows(int) const;
template void JointSet<float>::solver_rows(int, const SolverBodies<float>&,
                                           std::vector<JointSolverRow<float>>&);
template void JointSet<double>::solver_rows(int, const SolverBodies<double>&,
                                            std::vector<JointSolverRow<double>>&);

}  // namespace plumb
