#pragma once

#include <cstddef>

#include "engine/forces/wrench.h"
#include "engine/joints/row.h"
#include "engine/math/trigonometry.h"

namespace plumb {

/// A sinusoidal force at a point of the body: F = A sin(w t + phase).
struct SinusoidalForceLaw {
  std::size_t body = 0;
  Vec2d amplitude{};             ///< N, in the world's axes
  Vec2d point{};                 ///< m, in the body's frame
  double angular_frequency = 0;  ///< rad/s
  double phase = 0;              ///< rad

  /// Returns the mean of sin(w t + phase) over [t0, t1], sin(middle) sin(half) / half with the phase at the
  /// middle and half its change: a step's impulse is exact. At an instant, t0 == t1, the sine itself.
  double mean_sine(double t0, double t1) const {
    const double half = 0.5 * angular_frequency * (t1 - t0);
    const double middle = rotation_of(0.5 * angular_frequency * (t0 + t1) + phase).s;
    return half == 0 ? middle : middle * (rotation_of(half).s / half);
  }

  /// Returns the wrench with the amplitude as the force.
  constexpr Wrench<double> wrench(const Pose<double>& pose, const Twist<double>&) const {
    return {amplitude, cross(pose.rotation * point, amplitude)};
  }
};

}  // namespace plumb
