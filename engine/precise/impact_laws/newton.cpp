#include <cmath>
#include <initializer_list>

#include "engine/precise/impact_laws/impact_law.h"

namespace plumb::precise {

ContactImpulse newton_impulse(const ImpactPoint& point, const ImpactCoefficients& c) {
  const double nn = point.normal_response, nt = point.cross_response, tt = point.tangent_response;
  const double rate_change = -(1 + c.restitution) * point.gap_rate;  // change of the gap's rate
  const double determinant = nn * tt - nt * nt;
  const ContactImpulse stuck{(rate_change * tt + point.slip_speed * nt) / determinant,
                             -(rate_change * nt + point.slip_speed * nn) / determinant};
  if (std::abs(stuck.tangential) <= c.friction * stuck.normal) return stuck;
  // The contact slips at the end: in its initial direction or, if friction would then be too strong, in the
  // other.
  const double sign = point.slip_speed < 0 ? -1 : 1;
  for (const double direction : {sign, -sign}) {
    const double ratio = -direction * c.friction;
    const ContactImpulse slipping{rate_change / (nn + ratio * nt), ratio * rate_change / (nn + ratio * nt)};
    if (slipping.normal >= 0 && direction * slip_speed_after(point, slipping) >= 0) return slipping;
  }
  return stuck;  // at the edge of the cone: reached by rounding only
}

}  // namespace plumb::precise
