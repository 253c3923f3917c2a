#include "engine/precise/impact_laws/slip_path.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace plumb::precise {

SlipPath::SlipPath(const ImpactPoint& point, const ImpactCoefficients& c) : start_(point.gap_rate) {
  const double direction = point.slip_speed > 0 ? 1 : -1;
  first_ratio_ = point.slip_speed == 0 ? 0 : -direction * c.friction;
  const double slowing = point.cross_response + first_ratio_ * point.tangent_response;
  slip_end_ = 0;
  if (point.slip_speed != 0)
    slip_end_ =
        direction * slowing < 0 ? -point.slip_speed / slowing : std::numeric_limits<double>::infinity();
  // Sticking needs this fraction of the normal impulse as a tangential one. If friction cannot provide it,
  // the contact slips back.
  const double sticking = -point.cross_response / point.tangent_response;
  second_ratio_ = std::clamp(sticking, -c.later_friction, c.later_friction);
  first_slope_ = point.normal_response + first_ratio_ * point.cross_response;
  second_slope_ = point.normal_response + second_ratio_ * point.cross_response;
}

double SlipPath::gap_rate(double p) const {
  return start_ + first_slope_ * std::min(p, slip_end_) + second_slope_ * std::max(p - slip_end_, 0.0);
}

ContactImpulse SlipPath::impulse(double p) const {
  return {p, first_ratio_ * std::min(p, slip_end_) + second_ratio_ * std::max(p - slip_end_, 0.0)};
}

double SlipPath::compression() const {
  // With a slope that is not positive the contact jams (Painleve's paradox). The slip then stops, because the
  // responses are those of a mass matrix, and the second slope is positive.
  if (first_slope_ > 0 && -start_ <= first_slope_ * slip_end_) return -start_ / first_slope_;
  return slip_end_ - gap_rate(slip_end_) / second_slope_;
}

double SlipPath::work(double p, double q) const {
  const auto part = [&](double from, double to) { return (to - from) * (gap_rate(from) + gap_rate(to)) / 2; };
  if (slip_end_ <= p || slip_end_ >= q) return part(p, q);
  return part(p, slip_end_) + part(slip_end_, q);
}

double SlipPath::after_work(double work) const {
  const double end = compression();
  if (end >= slip_end_) return end + std::sqrt(2 * work / second_slope_);
  const double straight = end + std::sqrt(2 * work / first_slope_);
  if (straight <= slip_end_) return straight;
  const double rate = gap_rate(slip_end_), left = work - this->work(end, slip_end_);
  return slip_end_ + 2 * left / (rate + std::sqrt(rate * rate + 2 * second_slope_ * left));
}

}  // namespace plumb::precise
