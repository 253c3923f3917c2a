#include <algorithm>
#include <cmath>

#include "engine/precise/impact_laws/impact_law.h"

namespace plumb::precise {
namespace {

/// Fraction of the initial slip below which the final slip counts as zero, up to rounding.
constexpr double kStopped = 1e-9;

}  // namespace

ContactImpulse with_tangential_restitution(const ImpactPoint& point, const ImpactCoefficients& c,
                                           const ContactImpulse& impulse) {
  if (c.tangential_restitution == 0 ||
      std::abs(slip_speed_after(point, impulse)) > kStopped * std::abs(point.slip_speed))
    return impulse;
  const double direction = point.slip_speed > 0 ? -1 : 1;
  double added = c.tangential_restitution * std::abs(point.slip_speed) / point.tangent_response;
  const double cone = std::max(c.friction, c.later_friction) * impulse.normal;
  added = std::min(added, std::max(0.0, cone - direction * impulse.tangential));
  // From zero slip, the added impulse costs the energy tangent_response more^2 / 2, which must not exceed the
  // energy lost so far.
  const double lost = std::max(0.0, -energy_change(point, impulse));
  added = std::min(added, std::sqrt(2 * lost / point.tangent_response));
  const double opening = gap_rate_after(point, impulse), change = direction * point.cross_response;
  if (change < 0) added = std::min(added, std::max(0.0, opening) / -change);
  return {impulse.normal, impulse.tangential + direction * added};
}

}  // namespace plumb::precise
