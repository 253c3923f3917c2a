#include "engine/precise/impact_laws/slip_path.h"

namespace plumb::precise {

ContactImpulse stronge_impulse(const ImpactPoint& point, const ImpactCoefficients& coefficients) {
  const SlipPath path(point, coefficients);
  const double taken = -path.work(0, path.compression());
  return path.impulse(path.after_work(coefficients.restitution * coefficients.restitution * taken));
}

}  // namespace plumb::precise
