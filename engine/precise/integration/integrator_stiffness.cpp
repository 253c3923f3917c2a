#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/precise/integration/integrator.h"

// Switches between the explicit and the implicit method.
namespace plumb::precise {

/// Switches to the implicit method when only stability limits the steps. Switches back when steps are so
/// short that the explicit method could make them as well.
void EventFreeIntegrator::update_stiffness() {
  constexpr double kStable = 6.1;  // stability limit of DOP853 for step length times rate
  constexpr int kSigns = 15, kPause = 6, kLookEvery = 10;
  const double h = time_ - start_;
  if (!stiff_) {
    rate_at_end();
    if (current().method.stiffness(h, coordinates_of(y_), current().error_scale) > kStable) {
      nonstiff_steps_ = 0;
      if (++signs_of_stiffness_ < kSigns) return;
    } else {
      if (++nonstiff_steps_ >= kPause) signs_of_stiffness_ = 0;
      return;
    }
  } else {
    if (++nonstiff_steps_ < kLookEvery) return;
    nonstiff_steps_ = 0;
    if (h * spectral_radius() > kStable / 2) return;
  }
  stiff_ = !stiff_;
  if (!tree_.empty()) rate_known_ = false;  // the known rate is of other coordinates
  signs_of_stiffness_ = nonstiff_steps_ = 0;
  control_.reset();
  implicit_.forget();
}

/// Estimates the largest modulus of an eigenvalue of d(rate)/dy, 1/s, by the power method on differences of
/// rates: two applications at a time, because positions and velocities alternate in an oscillation.
double EventFreeIntegrator::spectral_radius() {
  constexpr double kShift = 1e-7;
  constexpr int kPairs = 3;
  const std::span<const double> rate = rate_at_end();
  std::vector<double> y(y_.size()), out(y_.size()), direction(y_.size());
  for (std::size_t i = 0; i < direction.size(); ++i) {  // arbitrary, with a part of every mode
    const double mixed = static_cast<double>(static_cast<std::uint32_t>(i + 1) * 2654435761u) / 4294967296.0;
    direction[i] = all_.error_scale[i] * (mixed - 0.5);
  }
  const auto size = [&](std::span<const double> v) {
    double largest = 0;
    for (std::size_t i = 0; i < v.size(); ++i) {
      largest = std::max(largest, std::abs(v[i]) * (tolerance_ / all_.error_scale[i]));
    }
    return largest;
  };
  double growth = 0;
  for (int pair = 0; pair < kPairs; ++pair) {
    growth = 1;
    for (int i = 0; i < 2; ++i) {
      const double before = size(direction);
      if (!(before > 0) || !std::isfinite(before)) return 0;
      for (std::size_t k = 0; k < y.size(); ++k) y[k] = y_[k] + direction[k] * (kShift / before);
      equations_.rate(time_, y, out);
      for (std::size_t k = 0; k < y.size(); ++k) direction[k] = (out[k] - rate[k]) / kShift;
      growth *= size(direction);
    }
  }
  return std::sqrt(growth);
}

}  // namespace plumb::precise
