#pragma once

#include "engine/joints/joint_row.h"

namespace plumb {

/// A common point, q = anchor b - anchor a = 0, about which the bodies turn by the angle.
template <class Real>
struct RevoluteRows : JointTraits<0, 0> {
  using Definition = RevoluteDefinition;
  static constexpr bool kPoint = true, kTurn = true;
  static constexpr AngleUse kAngle = AngleUse::Counted;

  Vec2<Real> anchor_a{}, anchor_b{};  ///< m, from the centres of mass, in the bodies' frames
  double reference = 0;               ///< rad, of b relative to a where the joint's angle is 0

  RevoluteRows() = default;
  RevoluteRows(const Definition& definition, Vec2d centre_a, Vec2d centre_b);

  [[gnu::always_inline]] void evaluate(const JointPose<Real>& pose, JointRows<Real>& out) const {
    out.point = anchor_point(pose, anchor_a, anchor_b).middle();
  }
};

JointRules rules_of(const RevoluteDefinition& definition);

}  // namespace plumb
