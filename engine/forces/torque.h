#pragma once

#include <cstddef>

#include "engine/forces/wrench.h"
#include "engine/joints/row.h"

namespace plumb {

/// A pure torque.
template <class Real>
struct TorqueLaw {
  std::size_t body = 0;
  Real torque = 0;                 ///< N m
  double start = 0, duration = 0;  ///< s

  constexpr Wrench<Real> wrench(const Pose<Real>&, const Twist<Real>&) const { return {{}, torque}; }
};

}  // namespace plumb
