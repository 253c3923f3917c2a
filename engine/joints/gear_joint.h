#pragma once

#include "engine/joints/joint_row.h"

namespace plumb {

/// Angles in a fixed ratio: q = angle_b - ratio angle_a - phase = 0, whole turns of each body counted.
template <class Real>
struct GearRows : JointTraits<0, 1> {
  using Definition = GearDefinition;
  static constexpr AngleUse kAngle = AngleUse::Geared;

  Real ratio = 1;
  double exact_ratio = 1, reference = 0;  ///< the phase, rad

  GearRows() = default;
  GearRows(const Definition& definition, Vec2d, Vec2d)
      : ratio(static_cast<Real>(definition.ratio)),
        exact_ratio(definition.ratio),
        reference(definition.phase) {}

  void evaluate(const JointPose<Real>& pose, JointRows<Real>& out) const {
    out.axial[0] = {{}, {}, -ratio, 1, pose.angle};
    out.arm_b = {};
  }
};

inline JointRules rules_of(const GearDefinition&) {
  JointRules rules;
  rules.axial[0].add({});
  return rules;
}

}  // namespace plumb
