#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "engine/integrate/step_polynomial.h"
#include "engine/integrate/stiff_flow.h"

namespace plumb {

/// One step of Radau IIA with 5 stages, order 9: L-stable, so that modes far faster than the step are damped
/// at once. The stages are solved by Newton's method.
class Radau {
 public:
  explicit Radau(std::size_t dimension);

  /// Steps from y at `time`, where dy/dt is `first_rate`, over `h`. The result is y + increment(). Newton's
  /// method stops when its error is a hundredth of `scale`, by component. Returns false if it does not
  /// converge or yields non-finite values. The caller has to linearise the flow before.
  bool step(StiffFlow& flow, double time, double h, std::span<const double> y,
            std::span<const double> first_rate, std::span<const double> scale);

  std::span<const double> increment() const { return increment_; }

  /// Returns the last step's estimated error, the largest over the components relative to `scale`. It is the
  /// difference to a solution of order 5, filtered so that fast modes do not count (Hairer & Wanner II, IV.8,
  /// eq. (8.19)). With `again`, an estimate above 1 is filtered a second time, which first steps need.
  double error(StiffFlow& flow, double time, double h, std::span<const double> y,
               std::span<const double> first_rate, std::span<const double> scale, bool again);

  /// Computes the collocation polynomial over the last step, of degree 5.
  void polynomial(StepPolynomial& out) const;

  /// Declares that the next step does not continue the last: its Newton iteration starts from the rate at its
  /// start.
  void forget() { last_h_ = 0; }

  /// Data from which the next step starts Newton's method: the length of the last step and its stages' rates.
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
