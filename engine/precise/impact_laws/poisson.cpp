#include "engine/precise/impact_laws/slip_path.h"

namespace plumb::precise {

ContactImpulse poisson_impulse(const ImpactPoint& point, const ImpactCoefficients& coefficients) {
  const SlipPath path(point, coefficients);
  return path.impulse((1 + coefficients.restitution) * path.compression());
}

}  // namespace plumb::precise
