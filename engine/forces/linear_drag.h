#pragma once

#include <cstddef>

#include "engine/forces/wrench.h"
#include "engine/joints/row.h"

namespace plumb {

/// Drag of slow flow (Stokes): F = -c v, and the torque -c_r w.
template <class Real>
struct LinearDragLaw {
  std::size_t body = 0;
  Real coefficient = 0;          ///< N s/m
  Real angular_coefficient = 0;  ///< N m s

  constexpr Wrench<Real> wrench(const Pose<Real>&, const Twist<Real>& twist) const {
    return {-coefficient * twist.velocity, -angular_coefficient * twist.angular_velocity};
  }
};

}  // namespace plumb
