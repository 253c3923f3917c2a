#pragma once

#include "engine/joints/revolute_joint.h"

namespace plumb {

/// b held to a: anchor b - anchor a = 0 and the angle is 0, all three rows rigid and solved together.
template <class Real>
struct WeldRows : JointTraits<3, 0> {
  using Definition = WeldDefinition;
  static constexpr AngleUse kAngle = AngleUse::Counted;

  Vec2<Real> anchor_a{}, anchor_b{};  ///< m, from the centres of mass, in the bodies' frames
  double reference = 0;               ///< rad

  WeldRows() = default;
  WeldRows(const Definition& definition, Vec2d centre_a, Vec2d centre_b)
      : anchor_a((definition.anchor_a - centre_a).as<Real>()),
        anchor_b((definition.anchor_b - centre_b).as<Real>()),
        reference(definition.reference_angle) {}

  [[gnu::always_inline]] void evaluate(const JointPose<Real>& pose, JointRows<Real>& out) const {
    const AnchorPoint<Real> point = anchor_point(pose, anchor_a, anchor_b);
    const AnchorPoint<Real> middle = point.middle();
    out.block[0] = {{}, {}, -1, 1, pose.angle};
    out.block[1] = middle.plain_row({1, 0});
    out.block[2] = middle.plain_row({0, 1});
    out.arm_b = point.arm_b;
  }
};

/// The same with a spring for the point, for the angle or for both; the one without a spring is rigid.
template <class Real>
struct SoftWeldRows : RevoluteRows<Real> {
  using Definition = WeldDefinition;
  static constexpr bool kSoft = true;
  using RevoluteRows<Real>::RevoluteRows;
};

inline JointRules rules_of(const WeldDefinition& definition) {
  JointRules rules;
  if (definition.linear_spring) rules.point = {.role = RowRole::Spring, .spring = *definition.linear_spring};
  RowRule turn;
  if (definition.angular_spring) turn = {.role = RowRole::Spring, .spring = *definition.angular_spring};
  rules.angular.add(turn);
  return rules;
}

}  // namespace plumb
