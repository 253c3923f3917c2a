#pragma once

#include <algorithm>
#include <cmath>

namespace plumb {

/// How long the next step should be, from the errors of the last two (a PI controller, Gustafsson 1991, as in
/// Hairer, Norsett & Wanner, Solving Ordinary Differential Equations I, II.4). For a method whose error goes
/// with h^8. The exponents are 3/32 and 1/32, because roots by repeated `sqrt` have the same bits everywhere
/// and `pow` has not.
class StepControl {
 public:
  /// Of the length that would just meet the tolerance. Where errors change by more from step to step than a
  /// tenth of the length makes up for, a fifth saves more steps that have to be done again than it costs.
  static constexpr double kUsual = 0.9, kCareful = 0.8;
  explicit StepControl(double safety = kUsual) : safety_(safety) {}

  /// The factor for a step that met its tolerance with `error` <= 1.
  double after_acceptance(double error) {
    constexpr double kLeast = 1e-10;  // an error of zero says no more than this
    const double e = std::max(error, kLeast);
    const double r = root32(e);
    const double factor = safety_ * root32(previous_) / (r * r * r);
    previous_ = std::max(e, 1e-4);
    return std::clamp(factor, kShrinkMost, kGrowMost);
  }

  /// The factor for a step that has to be done again; 1/8 of the power, without history.
  double after_rejection(double error) const {
    if (!(error < 1e30)) return kShrinkMost;
    const double r = root32(error);
    return std::clamp(safety_ / ((r * r) * (r * r)), kShrinkMost, safety_);
  }

  /// The factor after a step of a method whose error goes with h^6: error^(-1/6) with 1/8 + 1/32 + 1/128 for
  /// the exponent.
  static double sixth_order(double error) {
    constexpr double kLeast = 1e-8;
    if (!(error < 1e30)) return kShrinkMost;
    const double e = std::max(error, kLeast), r32 = root32(e), r128 = std::sqrt(std::sqrt(r32));
    const double r8 = (r32 * r32) * (r32 * r32);
    return std::clamp(kUsual / (r8 * r32 * r128), kShrinkMost, 2 * kGrowMost);
  }

  double previous() const { return previous_; }
  void reset(double previous = 1) { previous_ = previous; }

 private:
  static double root32(double x) { return std::sqrt(std::sqrt(std::sqrt(std::sqrt(std::sqrt(x))))); }

  static constexpr double kShrinkMost = 0.2, kGrowMost = 4;
  double safety_, previous_ = 1;
};

}  // namespace plumb
