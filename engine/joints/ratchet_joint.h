#pragma once

#include <cmath>

#include "engine/joints/joint_row.h"

namespace plumb {

/// b turns relative to a in one direction, and back only to the last tooth passed: q = (angle - phase) /
/// tooth never falls below an integer that it has reached.
template <class Real>
struct RatchetRows : JointTraits<0, 0> {
  using Definition = RatchetDefinition;
  static constexpr bool kAngular = true;
  static constexpr AngleUse kAngle = AngleUse::Counted;
  /// In teeth: an angle this close below a tooth counts as on it, so that rounding at the start loses no
  /// tooth.
  static constexpr double kToothTolerance = 1e-3;

  double tooth = 1, reference = 0;  ///< rad; the phase

  RatchetRows() = default;
  RatchetRows(const Definition& definition, Vec2d, Vec2d)
      : tooth(definition.tooth), reference(definition.phase) {}

  void evaluate(const JointPose<Real>& pose, JointRows<Real>& out) const {
    static_cast<void>(pose);
    out.arm_b = {};
  }

  /// Returns the last tooth at or before the angle (less the phase).
  double tooth_at(double angle) const { return std::floor(angle / tooth + kToothTolerance); }
};

inline JointRules rules_of(const RatchetDefinition& definition) {
  JointRules rules;
  rules.angular.add({.role = RowRole::Limit, .sign = definition.tooth > 0 ? 1.0 : -1.0});
  return rules;
}

}  // namespace plumb
