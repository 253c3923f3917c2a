#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "engine/integrate/flow.h"
#include "engine/integrate/step_polynomial.h"

namespace plumb {

/// One step of DOP853, the explicit Runge-Kutta method of order 8 by Dormand and Prince. The last stage of a
/// step is not reused as the first of the next, because the caller may change y between steps; it then sets
/// `first_rate` again.
class Dop853 {
 public:
  explicit Dop853(std::size_t dimension);

  /// Returns dy/dt at the start of the step, to be set before `step`.
  std::span<double> first_rate() { return rates_.front(); }
  std::span<const double> first_rate() const { return rates_.front(); }

  /// Sets the flow's `power` at the start of the step; and at its end, together with `last_rate`.
  void set_first_power(double power) { powers_.front() = power; }
  void set_last_power(double power) { powers_[kLast] = power; }
  double last_power() const { return powers_[kLast]; }

  /// Steps from y at `time` over `h`: 11 evaluations of `flow`. The result is y + increment().
  void step(Flow& flow, double time, double h, std::span<const double> y);

  std::span<const double> increment() const { return increment_; }

  /// Returns the work of the flow's `power` over the last step, of length `h`: by the stages' own weights,
  /// and as accurate as the step.
  double work(double h) const;

  /// Returns the last step's estimated error: the largest over the components relative to `scale`, from the
  /// estimates of orders 5 and 3. Source: Hairer, Norsett & Wanner, II.10, eq. (10.17), with the largest in
  /// place of the mean.
  double error(double h, std::span<const double> scale) const;

  /// Computes both estimates of the last step by component, of orders 5 and 3. The static `error` combines
  /// them, after the caller may have subtracted a part.
  void error_vectors(double h, std::span<double> fifth, std::span<double> third) const;
  static double error(std::span<const double> scale, std::span<const double> fifth,
                      std::span<const double> third);

  /// Returns dy/dt at the end of the step, to be set before `polynomial`.
  std::span<double> last_rate();
  std::span<const double> last_rate() const;

  /// Returns the step's length times the largest rate of change of the motion, from the last stage and the
  /// step's end `y_end` with its `last_rate`. Above about 6 the method is unstable, and stability alone
  /// limits the steps (Hairer & Wanner, Solving Ordinary Differential Equations II, IV.2). To be called right
  /// after a step.
  double stiffness(double h, std::span<const double> y_end, std::span<const double> scale) const;

  /// Computes the polynomial of order 7 over the last step, from `y` at `time` over `h`: 3 evaluations of
  /// `flow` (Hairer, Norsett & Wanner, II.6, and their program).
  void polynomial(Flow& flow, double time, double h, std::span<const double> y, StepPolynomial& out);

  /// Makes the end of the last step the start of the next: `last_rate` becomes `first_rate`.
  void advance();

 private:
  template <class Store>
  void weighted_sum(const double* weights, int stages, const Store& store) const;

  static constexpr std::size_t kLast = 12;  // after the stages
  std::array<double, kLast + 1> powers_{};  // by stage
  std::vector<std::vector<double>> rates_;  // by stage; the last one of the step; the polynomial's stages
  std::size_t dimension_;
  std::vector<double> at_stage_, increment_;
};

}  // namespace plumb
