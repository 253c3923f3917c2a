#pragma once

#include "engine/math/vec2.h"

namespace plumb {

/// Index of the fixed frame where a body's index stands.
inline constexpr int kFixedFrame = -1;

/// Where a body is, as a constraint sees it.
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

/// One scalar constraint C(q) = 0 between two bodies, linearised: dC/dt = J v.
template <class Real>
struct Row {
  int a = kFixedFrame, b = kFixedFrame;
  Vec2<Real> linear_a{}, linear_b{};  ///< dC/d(position), per body
  Real angular_a = 0, angular_b = 0;  ///< dC/d(angle), per body
  Real residual = 0;                  ///< C, m
  Real bias_acceleration = 0;         ///< (dJ/dt) v, m/s^2: C'' = J a + this
};

}  // namespace plumb
