#pragma once

#include <cmath>
#include <utility>

#include "engine/forces/wrench.h"
#include "engine/joints/row.h"

namespace plumb {

/// Hooke's law with viscous damping: the tension k (l - l0) + c dl/dt along the line between two points.
struct SpringForceLaw {
  int a = kFixedFrame, b = kFixedFrame;
  Vec2d anchor_a{}, anchor_b{};  ///< m, in the bodies' frames
  double rest_length = 0;        ///< m
  double stiffness = 0;          ///< N/m
  double damping = 0;            ///< N s/m

  /// Returns the wrenches on a and on b.
  std::pair<Wrench<double>, Wrench<double>> wrenches(const Pose<double>& pose_a, const Twist<double>& twist_a,
                                                     const Pose<double>& pose_b,
                                                     const Twist<double>& twist_b) const {
    const Vec2d arm_a = pose_a.rotation * anchor_a, arm_b = pose_b.rotation * anchor_b;
    const Vec2d offset = (pose_b.position + arm_b) - (pose_a.position + arm_a);
    const double length = std::sqrt(length_squared(offset));
    if (length == 0) return {};  // no direction to pull in
    const Vec2d axis = (1 / length) * offset;
    const Vec2d speed_a = twist_a.velocity + cross(twist_a.angular_velocity, arm_a);
    const Vec2d speed_b = twist_b.velocity + cross(twist_b.angular_velocity, arm_b);
    const double tension = stiffness * (length - rest_length) + damping * dot(axis, speed_b - speed_a);
    const Vec2d pull = tension * axis;
    return {{pull, cross(arm_a, pull)}, {-pull, -cross(arm_b, pull)}};
  }

  /// Returns the elastic energy k (l - l0)^2 / 2, J.
  double energy(const Pose<double>& pose_a, const Pose<double>& pose_b) const {
    const Vec2d offset =
        (pose_b.position + pose_b.rotation * anchor_b) - (pose_a.position + pose_a.rotation * anchor_a);
    const double stretch = std::sqrt(length_squared(offset)) - rest_length;
    return stiffness * stretch * stretch / 2;
  }
};

}  // namespace plumb
