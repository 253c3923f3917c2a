#include "engine/precise/impact_laws/slip_path.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace plumb::precise {

SlipPath::SlipPath(const ImpactPoint& point, const ImpactCoefficients& c) : start_(point.closing) {
  const double way = point.slip > 0 ? 1 : -1;
  first_share_ = point.slip == 0 ? 0 : -way * c.friction;
  const double slowing = point.cross_response + first_share_ * point.tangent_response;
  bend_ = 0;
  if (point.slip != 0)
    bend_ = way * slowing < 0 ? -point.slip / slowing : std::numeric_limits<double>::infinity();
  // Sticking needs this fraction of the normal impulse as a tangential one. If friction cannot provide it,
  // the contact slips back.
  const double sticking = -point.cross_response / point.tangent_response;
  second_share_ = std::clamp(sticking, -c.later_friction, c.later_friction);
  first_slope_ = point.normal_response + first_share_ * point.cross_response;
  second_slope_ = point.normal_response + second_share_ * point.cross_response;
}

double SlipPath::closing(double p) const {
  return start_ + first_slope_ * std::min(p, bend_) + second_slope_ * std::max(p - bend_, 0.0);
}

ContactImpulse SlipPath::impulse(double p) const {
  return {p, first_share_ * std::min(p, bend_) + second_share_ * std::max(p - bend_, 0.0)};
}

double SlipPath::compression() const {
  // With a slope that is not positive the contact jams (Painleve's paradox). The slip then stops, because the
  // responses are those of a mass matrix, and the second slope is positive.
  if (first_slope_ > 0 && -start_ <= first_slope_ * bend_) return -start_ / first_slope_;
  return bend_ - closing(bend_) / second_slope_;
}

double SlipPath::work(double p, double q) const {
  const auto part = [&](double from, double to) { return (to - from) * (closing(from) + closing(to)) / 2; };
  if (bend_ <= p || bend_ >= q) return part(p, q);
  return part(p, bend_) + part(bend_, q);
}

double SlipPath::after_work(double work) const {
  const double end = compression();
  if (end >= bend_) return end + std::sqrt(2 * work / second_slope_);
  const double straight = end + std::sqrt(2 * work / first_slope_);
  if (straight <= bend_) return straight;
  const double rate = closing(bend_), left = work - this->work(end, bend_);
  return bend_ + 2 * left / (rate + std::sqrt(rate * rate + 2 * second_slope_ * left));
}

}  // namespace plumb::precise
