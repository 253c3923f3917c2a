#pragma once

#include "engine/joints/joint_row.h"

namespace plumb {

/// b slides along an axis n of a without turning: the angle and n' . d are 0, q = n . d; d from anchor a to
/// anchor b, n' a quarter turn from n.
template <class Real>
struct PrismaticRows : JointTraits<2, 1> {
  using Definition = PrismaticDefinition;
  static constexpr AngleUse kAngle = AngleUse::Counted;

  Vec2<Real> anchor_a{}, anchor_b{};  ///< m, from the centres of mass, in the bodies' frames
  Vec2<Real> axis{};                  ///< in a's frame, of length 1
  double reference = 0;               ///< rad

  PrismaticRows() = default;
  PrismaticRows(const Definition& definition, Vec2d centre_a, Vec2d centre_b)
      : anchor_a((definition.anchor_a - centre_a).as<Real>()),
        anchor_b((definition.anchor_b - centre_b).as<Real>()),
        axis(unit(definition.axis).template as<Real>()),
        reference(definition.reference_angle) {}

  [[gnu::always_inline]] void evaluate(const JointPose<Real>& pose, JointRows<Real>& out) const {
    const AnchorPoint<Real> point = anchor_point(pose, anchor_a, anchor_b);
    const Vec2<Real> n = rotated(pose.rotation_a, axis);
    out.block[0] = {{}, {}, -1, 1, pose.angle};
    out.block[1] = point.row(perpendicular(n));
    out.axial[0] = point.row(n);
    out.arm_b = point.arm_b;
  }
};

inline JointRules rules_of(const PrismaticDefinition& definition) {
  JointRules rules;
  RowRules& along = rules.axial[0];
  along.add_spring(definition.spring, definition.target_translation);
  along.add_motor(definition.motor);
  along.add_limits(definition.limits);
  return rules;
}

}  // namespace plumb
