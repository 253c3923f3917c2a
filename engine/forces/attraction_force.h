#pragma once

#include <cmath>
#include <utility>

#include "engine/forces/wrench.h"
#include "engine/joints/row.h"

namespace plumb {

/// x^n for whole n, by repeated multiplication: the same bits on every platform.
constexpr double whole_power(double x, int n) {
  double power = 1;
  for (int i = 0; i < (n < 0 ? -n : n); ++i) power *= x;
  return n < 0 ? 1 / power : power;
}

/// A central force on a's centre of mass towards a point of b: F = mu m / r^n.
struct AttractionForceLaw {
  int a = kFixedFrame, b = kFixedFrame;
  Vec2d centre{};       ///< m, in b's frame
  double strength = 0;  ///< mu m, N m^n
  int exponent = 2;     ///< n

  /// Returns the wrenches on a and on b.
  std::pair<Wrench<double>, Wrench<double>> wrenches(const Pose<double>& pose_a, const Twist<double>&,
                                                     const Pose<double>& pose_b, const Twist<double>&) const {
    const Vec2d arm = pose_b.rotation * centre;
    const Vec2d offset = (pose_b.position + arm) - pose_a.position;
    const double distance = std::sqrt(length_squared(offset));
    if (distance == 0) return {};  // no direction to pull in
    // F r^ = mu m r / r^(n + 1)
    const Vec2d pull = (strength * whole_power(distance, -exponent - 1)) * offset;
    return {{pull, 0}, {-pull, -cross(arm, pull)}};
  }

  /// Returns the potential energy, J: -mu m / ((n - 1) r^(n - 1)), or mu m ln r for n = 1.
  double energy(const Pose<double>& pose_a, const Pose<double>& pose_b) const {
    const Vec2d offset = (pose_b.position + pose_b.rotation * centre) - pose_a.position;
    const double distance = std::sqrt(length_squared(offset));
    if (exponent == 1) return strength * std::log(distance);
    return -strength * whole_power(distance, 1 - exponent) / (exponent - 1);
  }
};

}  // namespace plumb
