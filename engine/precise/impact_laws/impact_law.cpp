#include "engine/precise/impact_laws/impact_law.h"

namespace plumb::precise {

double closing_after(const ImpactPoint& point, const ContactImpulse& impulse) {
  return point.closing + point.normal_response * impulse.normal + point.cross_response * impulse.tangential;
}

double slip_after(const ImpactPoint& point, const ContactImpulse& impulse) {
  return point.slip + point.cross_response * impulse.normal + point.tangent_response * impulse.tangential;
}

double energy_change(const ImpactPoint& point, const ContactImpulse& impulse) {
  // The work of an impulse is the impulse times the mean of the rates before and after it.
  return (impulse.normal * (point.closing + closing_after(point, impulse)) +
          impulse.tangential * (point.slip + slip_after(point, impulse))) /
         2;
}

}  // namespace plumb::precise
