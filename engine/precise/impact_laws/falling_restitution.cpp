#include <cmath>

#include "engine/precise/impact_laws/impact_law.h"

namespace plumb::precise {

double falling_restitution(double restitution, double speed, double yield_speed, double exponent) {
  if (yield_speed <= 0 || speed <= yield_speed) return restitution;
  const double ratio = yield_speed / speed;
  // Square roots are rounded correctly on every platform, so two of them are used; the library's power
  // function is not.
  return restitution * (exponent == 0.25 ? std::sqrt(std::sqrt(ratio)) : std::pow(ratio, exponent));
}

}  // namespace plumb::precise
