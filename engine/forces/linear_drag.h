#pragma once

#include <cstddef>

#include "engine/forces/wrench.h"
#include "engine/joints/row.h"

namespace plumb {

/// Drag of slow flow (Stokes): F = -c v.
template <class Real>
struct LinearDragLaw {
  std::size_t body = 0;
  Real coefficient = 0;  ///< N s/m

  constexpr Wrench<Real> wrench(const Pose<Real>&, const Twist<Real>& twist) const {
    return {-coefficient * twist.velocity, 0};
  }
};

}  // namespace plumb
