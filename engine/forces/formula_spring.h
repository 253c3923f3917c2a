#pragma once

#include <cmath>
#include <span>
#include <utility>

#include "engine/forces/wrench.h"
#include "engine/joints/row.h"
#include "engine/scene/formula.h"

namespace plumb {

/// A tension by a formula in the time, the distance of two points and its rate (`kSpringVariables`), along
/// their line.
struct FormulaSpringLaw {
  int a = kFixedFrame, b = kFixedFrame;
  Vec2d anchor_a{}, anchor_b{};  ///< m, in the bodies' frames
  Formula tension{};

  /// Returns the wrenches on a and on b.
  std::pair<Wrench<double>, Wrench<double>> wrenches(double time, const Pose<double>& pose_a,
                                                     const Twist<double>& twist_a, const Pose<double>& pose_b,
                                                     const Twist<double>& twist_b) const {
    const Vec2d arm_a = pose_a.rotation * anchor_a, arm_b = pose_b.rotation * anchor_b;
    const Vec2d offset = (pose_b.position + arm_b) - (pose_a.position + arm_a);
    const double length = std::sqrt(length_squared(offset));
    if (length == 0) return {};  // no direction to pull in
    const Vec2d axis = (1 / length) * offset;
    const Vec2d rate = (twist_b.velocity + cross(twist_b.angular_velocity, arm_b)) -
                       (twist_a.velocity + cross(twist_a.angular_velocity, arm_a));
    const double now[] = {time, length, dot(axis, rate)};
    const Vec2d pull = tension.at(std::span<const double>(now)) * axis;
    return {{pull, cross(arm_a, pull)}, {-pull, -cross(arm_b, pull)}};
  }
};

}  // namespace plumb
