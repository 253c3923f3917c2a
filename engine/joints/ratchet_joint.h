#pragma once

#include <cmath>

#include "engine/joints/joint_row.h"

namespace plumb {

/// b turns relative to a one way; back only to the last tooth that it passed: q = (angle - phase) / tooth
/// never falls below an integer that it has reached.
template <class Real>
struct RatchetRows : JointTraits<0, 0> {
  using Definition = RatchetDefinition;
  static constexpr bool kTurn = true;
  static constexpr AngleUse kAngle = AngleUse::Counted;
  /// How close to a tooth, in teeth, counts as there: what starts on one must not slip for a rounding.
  static constexpr double kReach = 1e-3;

  double tooth = 1, reference = 0;  ///< rad; the phase

  RatchetRows() = default;
  RatchetRows(const Definition& definition, Vec2d centre_a, Vec2d centre_b);

  void evaluate(const JointPose<Real>& pose, JointRows<Real>& out) const {
    static_cast<void>(pose);
    out.arm_b = {};
  }

  /// The last tooth at or before the angle (less the phase).
  double tooth_at(double angle) const { return std::floor(angle / tooth + kReach); }
};

JointRules rules_of(const RatchetDefinition& definition);

}  // namespace plumb
