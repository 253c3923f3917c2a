#include <cmath>
#include <initializer_list>

#include "engine/precise/impact_laws/impact_law.h"

namespace plumb::precise {

ContactImpulse newton_impulse(const ImpactPoint& point, const ImpactCoefficients& c) {
  const double nn = point.normal_response, nt = point.cross_response, tt = point.tangent_response;
  const double wanted = -(1 + c.restitution) * point.closing;  // change of the gap's rate
  const double determinant = nn * tt - nt * nt;
  const ContactImpulse stuck{(wanted * tt + point.slip * nt) / determinant,
                             -(wanted * nt + point.slip * nn) / determinant};
  if (std::abs(stuck.tangential) <= c.friction * stuck.normal) return stuck;
  // The contact slips at the end: in its initial direction or, if friction would then be too strong, in the
  // other.
  const double way = point.slip < 0 ? -1 : 1;
  for (const double direction : {way, -way}) {
    const double share = -direction * c.friction;
    const ContactImpulse slipping{wanted / (nn + share * nt), share * wanted / (nn + share * nt)};
    if (slipping.normal >= 0 && direction * slip_after(point, slipping) >= 0) return slipping;
  }
  return stuck;  // at the edge of the cone: reached by rounding only
}

}  // namespace plumb::precise
