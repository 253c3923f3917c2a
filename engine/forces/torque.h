#pragma once

#include <cstddef>

#include "engine/forces/wrench.h"
#include "engine/joints/row.h"

namespace plumb {

/// A pure torque.
struct TorqueLaw {
  std::size_t body = 0;
  double torque = 0;               ///< N m
  double start = 0, duration = 0;  ///< s

  constexpr Wrench<double> wrench(const Pose<double>&, const Twist<double>&) const { return {{}, torque}; }
};

}  // namespace plumb
