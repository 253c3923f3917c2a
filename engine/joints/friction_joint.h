#pragma once

#include "engine/joints/joint_row.h"

namespace plumb {

/// Resists the motion of b relative to a at b's anchor, and its rotation.
template <class Real>
struct FrictionRows : JointTraits<0, 0> {
  using Definition = FrictionDefinition;
  static constexpr bool kPoint = true, kSoft = true, kAngular = true;
  static constexpr AngleUse kAngle = AngleUse::Counted;

  Vec2<Real> anchor_a{}, anchor_b{};  ///< m, from the centres of mass, in the bodies' frames
  double reference = 0;               ///< rad

  FrictionRows() = default;
  FrictionRows(const Definition& definition, Vec2d centre_a, Vec2d centre_b)
      : anchor_a((definition.anchor_a - centre_a).as<Real>()),
        anchor_b((definition.anchor_b - centre_b).as<Real>()) {}

  void evaluate(const JointPose<Real>& pose, JointRows<Real>& out) const {
    out.point = anchor_point(pose, anchor_a, anchor_b).at_b();
  }
};

inline JointRules rules_of(const FrictionDefinition& definition) {
  JointRules rules;
  rules.point = {.role = RowRole::Motor, .max_force = definition.max_force};
  rules.angular.add({.role = RowRole::Motor, .max_force = definition.max_torque});
  return rules;
}

}  // namespace plumb
