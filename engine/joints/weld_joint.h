#pragma once

#include "engine/joints/joint_row.h"

namespace plumb {

/// b held to a: anchor b - anchor a = 0 and the angle is 0, all three rows rigid and solved together.
template <class Real>
struct WeldRows : JointTraits<3, 0> {
  using Definition = WeldDefinition;
  static constexpr AngleUse kAngle = AngleUse::Counted;

  Vec2<Real> anchor_a{}, anchor_b{};  ///< m, from the centres of mass, in the bodies' frames
  double reference = 0;               ///< rad

  WeldRows() = default;
  WeldRows(const Definition& definition, Vec2d centre_a, Vec2d centre_b);

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
struct SoftWeldRows : JointTraits<0, 0> {
  using Definition = WeldDefinition;
  static constexpr bool kPoint = true, kTurn = true;
  static constexpr AngleUse kAngle = AngleUse::Counted;

  Vec2<Real> anchor_a{}, anchor_b{};
  double reference = 0;

  SoftWeldRows() = default;
  SoftWeldRows(const Definition& definition, Vec2d centre_a, Vec2d centre_b);

  [[gnu::always_inline]] void evaluate(const JointPose<Real>& pose, JointRows<Real>& out) const {
    out.point = anchor_point(pose, anchor_a, anchor_b).middle();
  }
};

JointRules rules_of(const WeldDefinition& definition);

}  // namespace plumb
