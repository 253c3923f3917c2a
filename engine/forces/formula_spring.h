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
    const Line now = line(pose_a, twist_a, pose_b, twist_b);
    if (now.length == 0) return {};  // no direction to pull in
    const double values[] = {time, now.length, now.rate};
    const Vec2d pull = tension.at(std::span<const double>(values)) * now.axis;
    return {{pull, cross(now.arm_a, pull)}, {-pull, -cross(now.arm_b, pull)}};
  }

  /// The line of its two points.
  struct Line {
    Vec2d arm_a{}, arm_b{}, axis{};  ///< m, m, and a unit vector from a to b
    double length = 0, rate = 0;     ///< m, m/s
  };
  Line line(const Pose<double>& pose_a, const Twist<double>& twist_a, const Pose<double>& pose_b,
            const Twist<double>& twist_b) const {
    const Vec2d arm_a = pose_a.rotation * anchor_a, arm_b = pose_b.rotation * anchor_b;
    const Vec2d offset = (pose_b.position + arm_b) - (pose_a.position + arm_a);
    const double length = std::sqrt(length_squared(offset));
    if (length == 0) return {arm_a, arm_b};
    const Vec2d axis = (1 / length) * offset;
    const Vec2d rate = (twist_b.velocity + cross(twist_b.angular_velocity, arm_b)) -
                       (twist_a.velocity + cross(twist_a.angular_velocity, arm_a));
    return {arm_a, arm_b, axis, length, dot(axis, rate)};
  }
};

}  // namespace plumb
