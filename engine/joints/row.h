#pragma once

#include "engine/math/pose.h"

namespace plumb {

/// Stands for the fixed frame in place of a body's index.
inline constexpr int kFixedFrame = -1;

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
