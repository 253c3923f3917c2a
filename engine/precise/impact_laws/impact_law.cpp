#include "engine/precise/impact_laws/impact_law.h"

namespace plumb::precise {

double gap_rate_after(const ImpactPoint& point, const ContactImpulse& impulse) {
  return point.gap_rate + point.normal_response * impulse.normal + point.cross_response * impulse.tangential;
}

double slip_speed_after(const ImpactPoint& point, const ContactImpulse& impulse) {
  return point.slip_speed + point.cross_response * impulse.normal +
         point.tangent_response * impulse.tangential;
}

double energy_change(const ImpactPoint& point, const ContactImpulse& impulse) {
  // The work of an impulse is the impulse times the mean of the rates before and after it.
  return (impulse.normal * (point.gap_rate + gap_rate_after(point, impulse)) +
          impulse.tangential * (point.slip_speed + slip_speed_after(point, impulse))) /
         2;
}

}  // namespace plumb::precise
