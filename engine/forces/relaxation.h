#pragma once

#include "engine/math/vec2.h"

namespace plumb {

/// Returns (1 - exp(-x)) / x for x >= 0, without a library: the mean of a quantity that decays by exp(-x), as
/// a fraction of its initial value.
inline double mean_of_decay(double x) {
  if (x <= 0.25) {
    // 1 - x/2! + x^2/3! - ... + x^12/13!: below rounding for x <= 1/4.
    double sum = 1;
    for (int n = 13; n >= 2; --n) sum = 1 - x / n * sum;
    return sum;
  }
  // Here exp(-x) is negligible, and halving an infinite x below would not end.
  if (x > 64) return 1 / x;
  // exp(-x) = exp(-x / 2^k)^(2^k), with a short series for the small argument.
  double small = x;
  int halvings = 0;
  for (; small > 0.125; small *= 0.5) ++halvings;
  double decay = 1;
  for (int n = 10; n >= 1; --n) decay = 1 - small / n * decay;
  for (; halvings > 0; --halvings) decay *= decay;
  return (1 - decay) / x;
}

/// Returns the mean over `dt` of the drag -c v in m v' = -c v + load, from the equation's solution. A
/// constant force of this size leads to the exact velocity after `dt`, and never past the terminal velocity.
/// `inverse_mass` in 1/kg, `coefficient` c in N s/m, >= 0.
inline double mean_linear_drag(double velocity, double coefficient, double inverse_mass, double load,
                               double dt) {
  const double fraction = mean_of_decay(coefficient * inverse_mass * dt);
  return -(coefficient * fraction * velocity + (1 - fraction) * load);
}
inline Vec2d mean_linear_drag(Vec2d velocity, double coefficient, double inverse_mass, Vec2d load,
                              double dt) {
  const double fraction = mean_of_decay(coefficient * inverse_mass * dt);
  return -(coefficient * fraction * velocity + (1 - fraction) * load);
}

}  // namespace plumb
