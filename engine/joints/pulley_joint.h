#pragma once

#include <cmath>

#include "engine/joints/joint_row.h"

namespace plumb {

/// A rope over two fixed pulleys: q = |d_a| + ratio |d_b| is constant, d from a pulley to an anchor.
template <class Real>
struct PulleyRows : JointTraits<0, 1> {
  using Definition = PulleyDefinition;
  static constexpr bool kGrounded = true;
  static constexpr bool kLength = true;

  Vec2<Real> anchor_a{}, anchor_b{};  ///< m, from the centres of mass, in the bodies' frames
  Vec2d ground_a{}, ground_b{};       ///< m, in the world
  Real ratio = 1;

  PulleyRows() = default;
  PulleyRows(const Definition& definition, Vec2d centre_a, Vec2d centre_b)
      : anchor_a((definition.anchor_a - centre_a).as<Real>()),
        anchor_b((definition.anchor_b - centre_b).as<Real>()),
        ground_a(definition.ground_a),
        ground_b(definition.ground_b),
        ratio(static_cast<Real>(definition.ratio)) {}

  void evaluate(const JointPose<Real>& pose, JointRows<Real>& out) const {
    const Vec2<Real> arm_a = pose.rotation_a * anchor_a, arm_b = pose.rotation_b * anchor_b;
    const Vec2<Real> to_a = pose.offset_a + arm_a, to_b = pose.offset + arm_b;
    using std::sqrt;
    const Real length_a = sqrt(length_squared(to_a)), length_b = sqrt(length_squared(to_b));
    // An anchor at its pulley has no direction: the rope exerts no force on it.
    const Vec2<Real> u_a = length_a > 0 ? (1 / length_a) * to_a : Vec2<Real>{};
    const Vec2<Real> u_b = length_b > 0 ? (ratio / length_b) * to_b : Vec2<Real>{};
    out.axial[0] = {u_a, u_b, cross(arm_a, u_a), cross(arm_b, u_b), length_a + ratio * length_b};
    out.arm_b = arm_b;
  }
};

inline JointRules rules_of(const PulleyDefinition& definition) {
  JointRules rules;
  rules.axial[0].add({.origin = definition.length.value_or(0)});
  return rules;
}

}  // namespace plumb
