#pragma once

#include <cstddef>

#include "engine/forces/wrench.h"
#include "engine/joints/row.h"
#include "engine/scene/scene.h"

namespace plumb {

/// A force at a point of the body: torque = r x F about the centre of mass, r and F in the world's axes.
struct PointForceLaw {
  std::size_t body = 0;
  Vec2d force{};  ///< N, in `frame`
  Vec2d point{};  ///< m, in the body's frame
  Frame frame = Frame::World;
  double start = 0, duration = 0;  ///< s

  constexpr Wrench<double> wrench(const Pose<double>& pose, const Twist<double>&) const {
    const Vec2d acting = frame == Frame::Body ? pose.rotation * force : force;
    return {acting, cross(pose.rotation * point, acting)};
  }
};

}  // namespace plumb
