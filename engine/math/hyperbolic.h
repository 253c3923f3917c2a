#pragma once

#include <cmath>

#include "engine/math/exponential.h"

namespace plumb {

/// Returns the hyperbolic sine, with the same bits everywhere.
inline double hyperbolic_sine(double x) {
  if (std::abs(x) < 0.25) {
    // x + x^3/3! + ... + x^13/13!, without the cancellation of e^x - e^-x.
    double sum = 0;
    for (int n = 12; n >= 2; n -= 2) sum = (1 + sum) * (x * x / (n * (n + 1)));
    return x + x * sum;
  }
  const double grown = exponential(0.5 * std::abs(x));
  const double size = 0.5 * grown * grown - 0.5 / (grown * grown);
  return x < 0 ? -size : size;
}

/// Returns the hyperbolic cosine, with the same bits everywhere.
inline double hyperbolic_cosine(double x) {
  const double grown = exponential(0.5 * std::abs(x));
  return 0.5 * grown * grown + 0.5 / (grown * grown);
}

/// Returns the hyperbolic tangent, with the same bits everywhere.
inline double hyperbolic_tangent(double x) {
  if (std::abs(x) > 20) return x > 0 ? 1 : -1;  // the rest is below rounding
  return hyperbolic_sine(x) / hyperbolic_cosine(x);
}

}  // namespace plumb
