#pragma once

#include "engine/joints/joint_row.h"

namespace plumb {

/// A common point, q = anchor b - anchor a = 0.
template <class Real>
struct HingeRows : JointTraits<0, 0> {
  using Definition = RevoluteDefinition;
  static constexpr bool kPoint = true;

  Vec2<Real> anchor_a{}, anchor_b{};  ///< m, from the centres of mass, in the bodies' frames

  HingeRows() = default;
  HingeRows(const auto& definition, Vec2d centre_a, Vec2d centre_b)
      : anchor_a((definition.anchor_a - centre_a).template as<Real>()),
        anchor_b((definition.anchor_b - centre_b).template as<Real>()) {}

  [[gnu::always_inline]] void evaluate(const JointPose<Real>& pose, JointRows<Real>& out) const {
    out.point = anchor_point(pose, anchor_a, anchor_b).middle();
  }
};

/// A common point about which the bodies turn by the angle.
template <class Real>
struct RevoluteRows : HingeRows<Real> {
  static constexpr bool kAngular = true;
  static constexpr AngleUse kAngle = AngleUse::Counted;

  double reference = 0;  ///< rad, of b relative to a where the joint's angle is 0

  RevoluteRows() = default;
  RevoluteRows(const auto& definition, Vec2d centre_a, Vec2d centre_b)
      : HingeRows<Real>(definition, centre_a, centre_b), reference(definition.reference_angle) {}
};

inline JointRules rules_of(const RevoluteDefinition& definition) {
  JointRules rules;
  rules.angular.add_spring(definition.spring, definition.target_angle);
  rules.angular.add_motor(definition.motor);
  rules.angular.add_limits(definition.limits);
  return rules;
}

}  // namespace plumb
