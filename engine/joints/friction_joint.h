#pragma once

#include "engine/joints/joint_row.h"

namespace plumb {

/// Resists the motion of b relative to a at b's anchor, and its rotation.
template <class Real>
struct FrictionRows : JointTraits<0, 0> {
  using Definition = FrictionDefinition;
  static constexpr bool kPoint = true, kTurn = true;
  static constexpr AngleUse kAngle = AngleUse::Counted;

  Vec2<Real> anchor_a{}, anchor_b{};  ///< m, from the centres of mass, in the bodies' frames
  double reference = 0;               ///< rad

  FrictionRows() = default;
  FrictionRows(const Definition& definition, Vec2d centre_a, Vec2d centre_b);

  void evaluate(const JointPose<Real>& pose, JointRows<Real>& out) const {
    out.point = anchor_point(pose, anchor_a, anchor_b).at_b();
  }
};

JointRules rules_of(const FrictionDefinition& definition);

}  // namespace plumb
