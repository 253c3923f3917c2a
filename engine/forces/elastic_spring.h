#pragma once

#include <algorithm>

#include "engine/forces/relaxation.h"

namespace plumb {

/// Hooke's law with viscous damping along the line between two points.
struct ElasticSpring {
  double stiffness = 100;   ///< N/m, >= 0
  double damping = 0;       ///< N s/m, >= 0
  double rest_length = 1;   ///< m, >= 0
  bool pulls_only = false;  ///< a rubber band: slack below its rest length
};

/// Returns the mean tension over `dt`, N; positive pulls. `length` (m) and `rate` (m/s) are those at the
/// start of `dt`; `inverse_mass` (1/kg) is that of both ends along the line. The elastic force is evaluated
/// at the predicted middle of the step, which exactly conserves the area in phase space. The phase advances
/// by theta per step: cos(theta) = 1 - (omega dt)^2 / 2. The damping force is the mean over the step of a
/// force that decays with the rate, so it never reverses the rate. Stiffness is limited to omega dt = 1,
/// because a step cannot follow faster oscillations.
inline double spring_tension(const ElasticSpring& spring, double length, double rate, double inverse_mass,
                             double dt) {
  const double stretch = length + 0.5 * dt * rate - spring.rest_length;
  if (spring.pulls_only && stretch <= 0) return 0;
  const double stiffest = inverse_mass > 0 ? 1 / (inverse_mass * dt * dt) : 0;
  const double elastic = std::min(spring.stiffness, stiffest) * stretch;
  const double tension = elastic - mean_linear_drag(rate, spring.damping, inverse_mass, 0, dt);
  return spring.pulls_only ? std::max(tension, 0.0) : tension;
}

}  // namespace plumb
