#pragma once

#include <cmath>
#include <cstddef>

#include "engine/forces/wrench.h"
#include "engine/joints/row.h"

namespace plumb {

/// Drag of fast flow (Newton): F = -c |v| v.
struct QuadraticDragLaw {
  std::size_t body = 0;
  double coefficient = 0;  ///< N s^2/m^2

  Wrench<double> wrench(const Pose<double>&, const Twist<double>& twist) const {
    const double speed = std::sqrt(length_squared(twist.velocity));
    return {(-coefficient * speed) * twist.velocity, 0};
  }
};

}  // namespace plumb
