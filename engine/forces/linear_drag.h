#pragma once

#include <cstddef>

#include "engine/forces/wrench.h"
#include "engine/joints/row.h"

namespace plumb {

/// Drag of slow flow (Stokes): F = -c v, and the torque -c_r w.
struct LinearDragLaw {
  std::size_t body = 0;
  double coefficient = 0;          ///< N s/m
  double angular_coefficient = 0;  ///< N m s

  constexpr Wrench<double> wrench(const Pose<double>&, const Twist<double>& twist) const {
    return {-coefficient * twist.velocity, -angular_coefficient * twist.angular_velocity};
  }
};

}  // namespace plumb
