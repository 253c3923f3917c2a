#pragma once

#include <cmath>

#include "scenarios/truth/motion.h"

namespace plumb::scenarios::truth {

/// Returns the motion on Kepler's ellipse of half-axis 1 m with mu = 1 m^3/s^2 about a focus at the origin,
/// from the pericentre at t = 0. Kepler's equation E - e sin E = t by Newton's method.
inline Motion orbit(Real e, Real time) {
  const Real minor = std::sqrt(1 - e * e);
  Real anomaly = time;
  for (int i = 0; i < 30; ++i)
    anomaly -= (anomaly - e * std::sin(anomaly) - time) / (1 - e * std::cos(anomaly));
  const auto [c, s] = direction(anomaly);
  const Real rate = 1 / (1 - e * c);
  return {{c - e, minor * s}, 0, {-rate * s, rate * minor * c}, 0};
}

}  // namespace plumb::scenarios::truth
