#pragma once

#include <type_traits>
#include <variant>

#include "engine/precise/dynamics/joints.h"

// Shared parts of the implementation of GeneralJoints.
namespace plumb::precise {

/// Pose and motion of a joint's two bodies; derivatives are along `Directions`.
struct GeneralJoints::JointMotion {
  JointPose<Dual> pose{};
  Vec2<Dual> velocity_a{}, velocity_b{};
  Dual spin_a{}, spin_b{};
};

/// Rates of change of the poses and velocities of both bodies along the direction of differentiation.
struct GeneralJoints::Directions {
  Twist<double> pose_a{}, pose_b{}, motion_a{}, motion_b{};
};

/// Forces on both bodies.
struct GeneralJoints::JointForces {
  Wrench<Dual> a{}, b{};

  void add(const JointRow<Dual>& row, Dual lambda) {
    a.force += lambda * row.linear_a, a.torque += lambda * row.angular_a;
    b.force += lambda * row.linear_b, b.torque += lambda * row.angular_b;
  }
};

/// Calls visit.row(row, rule) for each scalar coordinate with each of its rules, and visit.point(point, rule)
/// for a point whose rule is not rigid. C is the residual of the row.
template <class Visit>
void GeneralJoints::for_each_coordinate(const Entry& e, const JointMotion& ends, const Visit& visit) {
  std::visit(
      [&](const auto& kind) {
        using Rows = std::remove_cvref_t<decltype(kind)>;
        JointRows<Dual> rows;
        kind.evaluate(ends.pose, rows);
        const auto coordinate = [&](JointRow<Dual> row, const RowRules& rules) {
          const Dual q = row.residual;
          for (int i = 0; i < rules.count; ++i) {
            row.residual = q - rules.rule[i].origin;
            visit.row(row, rules.rule[i]);
          }
        };
        for (int i = 0; i < Rows::kBlock; ++i) visit.row(rows.block[i], RowRule{});
        for (int i = 0; i < Rows::kAxial; ++i) coordinate(rows.axial[i], e.rules.axial[i]);
        if constexpr (Rows::kAngular) coordinate({{}, {}, -1, 1, ends.pose.angle}, e.rules.angular);
        if constexpr (Rows::kPoint) {
          if (e.rules.point.role == RowRole::Rigid) {
            visit.row(rows.point.plain_row({1, 0}), e.rules.point);
            visit.row(rows.point.plain_row({0, 1}), e.rules.point);
          } else {
            visit.point(rows.point, e.rules.point);
          }
        }
      },
      e.kind);
}

/// Calls `take(row)` for each rigid row.
template <class Take>
struct RigidRows {
  const Take& take;
  void row(const JointRow<Dual>& j, const RowRule& rule) const {
    if (rule.role == RowRole::Rigid) take(j);
  }
  void point(const AnchorPoint<Dual>&, const RowRule&) const {}
};
template <class Take>
RigidRows(const Take&) -> RigidRows<Take>;

/// Calls `take(row, rule)` for each limit and motor.
template <class Take>
struct LimitMotorRows {
  const Take& take;
  void row(const JointRow<Dual>& j, const RowRule& rule) const {
    if (rule.role == RowRole::Limit || rule.role == RowRole::Motor) take(j, rule);
  }
  void point(const AnchorPoint<Dual>&, const RowRule&) const {}
};
template <class Take>
LimitMotorRows(const Take&) -> LimitMotorRows<Take>;

}  // namespace plumb::precise
