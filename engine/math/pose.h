#pragma once

#include "engine/math/vec2.h"

namespace plumb {

/// Position and rotation of a body, or of a frame in another one.
template <class Real>
struct Pose {
  Vec2<Real> position{};
  Rotation<Real> rotation{};
};

/// Velocity and angular velocity of a body.
template <class Real>
struct Twist {
  Vec2<Real> velocity{};
  Real angular_velocity = 0;
};

}  // namespace plumb
