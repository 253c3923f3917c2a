#pragma once

#include <cstddef>

#include "engine/forces/wrench.h"
#include "engine/joints/row.h"
#include "engine/scene/scene.h"

namespace plumb {

/// A force at a point of the body: torque = r x F about the centre of mass, r and F in the world's axes.
template <class Real>
struct PointForceLaw {
  std::size_t body = 0;
  Vec2<Real> force{};  ///< N, in `frame`
  Vec2<Real> point{};  ///< m, in the body's frame
  Frame frame = Frame::World;
  double start = 0, duration = 0;  ///< s

  constexpr Wrench<Real> wrench(const Pose<Real>& pose, const Twist<Real>&) const {
    const Vec2<Real> acting = frame == Frame::Body ? pose.rotation * force : force;
    return {acting, cross(pose.rotation * point, acting)};
  }
};

}  // namespace plumb
