#pragma once

#include <cmath>
#include <cstddef>

#include "engine/forces/wrench.h"
#include "engine/joints/row.h"

namespace plumb {

/// Drag of fast flow (Newton): F = -c |v| v.
template <class Real>
struct QuadraticDragLaw {
  std::size_t body = 0;
  Real coefficient = 0;  ///< N s^2/m^2

  Wrench<Real> wrench(const Pose<Real>&, const Twist<Real>& twist) const {
    const Real speed = std::sqrt(length_squared(twist.velocity));
    return {(-coefficient * speed) * twist.velocity, 0};
  }
};

}  // namespace plumb
