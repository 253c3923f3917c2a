#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "engine/integrate/step_polynomial.h"
#include "engine/integrate/stiff_flow.h"

namespace plumb {

/// One step of Radau IIA with 5 stages, order 9: L-stable, so that modes far faster than the step are damped
/// at once. Its stages are found by Newton's method.
class Radau {
 public:
  explicit Radau(std::size_t dimension);

  /// From y at `time`, where dy/dt is `first_rate`, over `h`. The result is y + increment(). Newton's method
  /// stops where its error is a hundredth of `scale`, by component; false when it does not get there, or
  /// finds what is not finite. The Jacobian is the caller's to take before.
  bool step(StiffFlow& flow, double time, double h, std::span<const double> y,
            std::span<const double> first_rate, std::span<const double> scale);

  std::span<const double> increment() const { return increment_; }

  /// The last step's estimated error, the largest over the components relative to `scale`: the difference to
  /// a solution of order 5, filtered so that fast modes do not count (Hairer & Wanner II, IV.8, eq. (8.19)).
  /// `again`: an estimate above 1 is filtered once more, which first steps need.
  double error(StiffFlow& flow, double time, double h, std::span<const double> y,
               std::span<const double> first_rate, std::span<const double> scale, bool again);

  /// The collocation polynomial over the last step, of degree 5.
  void polynomial(StepPolynomial& out) const;

  /// The last step is not what the next begins from: it starts Newton's method from the rate at its start.
  void forget() { last_h_ = 0; }

  /// What the next step's start of Newton's method comes from: the length of the last step and its stages'
  /// rates.
  double last_step() const { return last_h_; }
  std::span<const double> memory() const { return rates_; }
  void set_memory(double last_step, std::span<const double> rates);

  int iterations() const { return iterations_; }  ///< of the last step

 private:
  void guess(double h, std::span<const double> first_rate);

  std::size_t n_;
  std::vector<double> increment_, at_stage_, estimate_;
  std::vector<double> rates_, change_;  // stage after stage
  double last_h_ = 0;                   // s: of the step whose rates are in rates_; 0: none
  int iterations_ = 0;
};

}  // namespace plumb
