#pragma once

#include "engine/joints/joint_row.h"

namespace plumb {

/// A point of b at a point of the world: q = anchor b - target. a is not involved.
template <class Real>
struct MouseRows : JointTraits<0, 0> {
  using Definition = MouseDefinition;
  static constexpr bool kPoint = true, kSoft = true, kGrounded = true;

  Vec2<Real> anchor_b{};         ///< m, from the centre of mass, in b's frame
  Vec2d ground_a{}, ground_b{};  ///< m, the target, in the world

  MouseRows() = default;
  MouseRows(const Definition& definition, Vec2d, Vec2d centre_b)
      : anchor_b((definition.anchor_b - centre_b).as<Real>()),
        ground_a(definition.target),
        ground_b(definition.target) {}

  void evaluate(const JointPose<Real>& pose, JointRows<Real>& out) const {
    const Vec2<Real> arm_b = pose.rotation_b * anchor_b;
    out.point = {{}, arm_b, pose.offset + arm_b};
  }
};

inline JointRules rules_of(const MouseDefinition& definition) {
  JointRules rules;
  rules.point = {.role = RowRole::Spring, .spring = definition.spring, .max_force = definition.max_force};
  return rules;
}

}  // namespace plumb
