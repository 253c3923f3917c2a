#pragma once

#include "engine/math/vec2.h"

namespace plumb {

/// Where a body is, or where a frame lies in another one.
template <class Real>
struct Pose {
  Vec2<Real> position{};
  Rotation<Real> rotation{};
};

/// How a body moves.
template <class Real>
struct Twist {
  Vec2<Real> velocity{};
  Real angular_velocity = 0;
};

}  // namespace plumb
