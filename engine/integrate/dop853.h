#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "engine/integrate/flow.h"

namespace plumb {

/// One step of DOP853, the explicit Runge-Kutta method of order 8 by Dormand and Prince. The last stage of a
/// step is not the first of the next: the caller may move y between steps and then sets `first_rate` again.
class Dop853 {
 public:
  explicit Dop853(std::size_t dimension);

  /// dy/dt at the start of the step: to be set before `step`.
  std::span<double> first_rate() { return rates_[0]; }
  std::span<const double> first_rate() const { return rates_[0]; }

  /// From y at `time` over `h`: 11 evaluations of `flow`. The result is y + increment().
  void step(Flow& flow, double time, double h, std::span<const double> y);

  std::span<const double> increment() const { return increment_; }

  /// The last step's estimated error: the largest over the components relative to `scale`, from the estimates
  /// of orders 5 and 3 (Hairer, Norsett & Wanner, II.10, eq. (10.17) there with the largest in place of the
  /// mean).
  double error(double h, std::span<const double> scale) const;

 private:
  std::vector<std::vector<double>> rates_;  // by stage
  std::vector<double> at_stage_, increment_;
};

}  // namespace plumb
