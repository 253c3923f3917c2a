#pragma once

#include "engine/joints/joint_row.h"

namespace plumb {

/// A point of b at a point of the world: q = anchor b - target. a is not involved.
template <class Real>
struct MouseRows : JointTraits<0, 0> {
  using Definition = MouseDefinition;
  static constexpr bool kPoint = true, kGrounded = true;

  Vec2<Real> anchor_b{};         ///< m, from the centre of mass, in b's frame
  Vec2d ground_a{}, ground_b{};  ///< m, the target, in the world

  MouseRows() = default;
  MouseRows(const Definition& definition, Vec2d centre_a, Vec2d centre_b);

  void evaluate(const JointPose<Real>& pose, JointRows<Real>& out) const {
    const Vec2<Real> arm_b = pose.rotation_b * anchor_b;
    out.point = {{}, arm_b, pose.offset + arm_b};
  }
};

JointRules rules_of(const MouseDefinition& definition);

}  // namespace plumb
