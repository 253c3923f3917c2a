#pragma once

#include <cmath>

#include "engine/forces/relaxation.h"

namespace plumb {

/// Returns the mean over `dt` of the quadratic drag -c |v| v under a constant load. The factor c |v| is
/// evaluated at the middle of the step, predicted by the linear law with the initial factor. Of second order
/// in `dt`, exact at the terminal speed sqrt(load / c), and never reverses the motion. `coefficient` in N
/// s^2/m^2.
inline Vec2d mean_quadratic_drag(Vec2d velocity, double coefficient, double inverse_mass, Vec2d load,
                                 double dt) {
  const double first = coefficient * std::sqrt(length_squared(velocity));
  const Vec2d drag = mean_linear_drag(velocity, first, inverse_mass, load, 0.5 * dt);
  const Vec2d middle = velocity + (0.5 * dt * inverse_mass) * (drag + load);
  const double factor = coefficient * std::sqrt(length_squared(middle));
  return mean_linear_drag(velocity, factor, inverse_mass, load, dt);
}

}  // namespace plumb
