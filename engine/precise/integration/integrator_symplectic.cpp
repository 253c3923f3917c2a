#include <algorithm>
#include <cmath>

#include "engine/precise/integration/integrator.h"
#include "engine/scene/error.h"

// Steps of the symplectic method, and their length.
namespace plumb::precise {

/// Makes a step of fixed length, shorter only if it would go beyond `limit`.
double EventFreeIntegrator::symplectic_step(double limit) {
  if (proposed_step_ == 0) proposed_step_ = longest_symplectic_step();
  const double end = std::min(start_ + proposed_step_, limit);
  symplectic_.step(start_, end - start_, y_);
  time_ = end;
  rate_known_ = false;
  return end;
}

/// Finds a step length that meets the tolerance from here on. The error is the difference between one step
/// and two half steps.
double EventFreeIntegrator::longest_symplectic_step() {
  constexpr double kMinFraction = 1e-12;
  const auto fits = [&](double h) {
    Compensated whole = y0_, halves = y0_;
    symplectic_.step(start_, h, whole);
    symplectic_.step(start_, 0.5 * h, halves);
    symplectic_.step(start_ + 0.5 * h, 0.5 * h, halves);
    for (std::size_t i = 0; i < whole.size(); ++i) {
      if (!(std::abs(whole[i] - halves[i]) <= all_.error_scale[i])) return false;
    }
    return true;
  };
  const auto meets = [&](double h) {
    try {
      return fits(h);
    } catch (const Error&) {  // the joints cannot be closed after so long a step
      return false;
    }
  };
  // Rounded to float, so that sums of steps are exact.
  double h = static_cast<float>(first_step());
  const double min_step = kMinFraction * h;
  while (!meets(h) && h > min_step) h *= 0.5;
  if (h <= min_step) throw_step_underflow();
  while (2 * h <= longest_step_ && meets(1.25 * h)) h = static_cast<float>(1.25 * h);
  return h;
}

}  // namespace plumb::precise
