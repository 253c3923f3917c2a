#pragma once

#include "engine/joints/joint_row.h"

namespace plumb {

/// b turns freely about a point that slides along an axis n of a: n' . d = 0, q = n . d; d from anchor a to
/// anchor b, n' a quarter turn from n.
template <class Real>
struct WheelRows : JointTraits<0, 2> {
  using Definition = WheelDefinition;
  static constexpr bool kAngular = true;
  static constexpr AngleUse kAngle = AngleUse::Counted;

  Vec2<Real> anchor_a{}, anchor_b{};  ///< m, from the centres of mass, in the bodies' frames
  Vec2<Real> axis{};                  ///< in a's frame, of length 1
  double reference = 0;               ///< rad

  WheelRows() = default;
  WheelRows(const Definition& definition, Vec2d centre_a, Vec2d centre_b)
      : anchor_a((definition.anchor_a - centre_a).as<Real>()),
        anchor_b((definition.anchor_b - centre_b).as<Real>()),
        axis(unit(definition.axis).template as<Real>()) {}

  [[gnu::always_inline]] void evaluate(const JointPose<Real>& pose, JointRows<Real>& out) const {
    const AnchorPoint<Real> point = anchor_point(pose, anchor_a, anchor_b);
    const Vec2<Real> n = rotated(pose.rotation_a, axis);
    out.axial[0] = point.row(n);
    out.axial[1] = point.row(perpendicular(n));
    out.arm_b = point.arm_b;
  }
};

inline JointRules rules_of(const WheelDefinition& definition) {
  JointRules rules;
  rules.angular.add_motor(definition.motor);
  rules.axial[0].add_spring(definition.spring, 0);
  rules.axial[0].add_limits(definition.limits);
  rules.axial[1].add({});
  return rules;
}

}  // namespace plumb
