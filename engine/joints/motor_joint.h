#pragma once

#include "engine/joints/joint_row.h"

namespace plumb {

/// b's origin is driven to a point of a's frame, and b to an angle to a, by springs of bounded force and
/// torque.
template <class Real>
struct MotorRows : JointTraits<0, 0> {
  using Definition = MotorDefinition;
  static constexpr bool kPoint = true, kSoft = true, kAngular = true;
  static constexpr AngleUse kAngle = AngleUse::Counted;

  Vec2<Real> anchor_a{}, anchor_b{};  ///< m, from the centres of mass, in the bodies' frames
  double reference = 0;               ///< rad, the target

  MotorRows() = default;
  MotorRows(const Definition& definition, Vec2d centre_a, Vec2d centre_b)
      : anchor_a((definition.target_position - centre_a).as<Real>()),
        anchor_b((-centre_b).as<Real>()),
        reference(definition.target_angle) {}

  void evaluate(const JointPose<Real>& pose, JointRows<Real>& out) const {
    out.point = anchor_point(pose, anchor_a, anchor_b).at_b();
  }
};

inline JointRules rules_of(const MotorDefinition& definition) {
  JointRules rules;
  rules.point = {.role = RowRole::Spring, .spring = definition.spring, .max_force = definition.max_force};
  rules.angular.add(
      {.role = RowRole::Spring, .spring = definition.spring, .max_force = definition.max_torque});
  return rules;
}

}  // namespace plumb
