#pragma once

#include <algorithm>
#include <cmath>

namespace plumb {

/// Chooses the length of the next step from the errors of the last two, for a method whose error is
/// proportional to h^8. A PI controller (Gustafsson 1991), as in Hairer, Norsett & Wanner, Solving Ordinary
/// Differential Equations I, II.4. The exponents are 3/32 and 1/32, because repeated `sqrt` has the same bits
/// on every platform and `pow` has not.
class StepControl {
 public:
  /// Safety factors on the length that would just meet the tolerance. kCareful is better if errors vary so
  /// much from step to step that kUsual would cause more rejected steps than it saves.
  static constexpr double kUsual = 0.9, kCareful = 0.8;
  explicit StepControl(double safety = kUsual) : safety_(safety) {}

  /// Returns the factor for a step that met its tolerance with `error` <= 1.
  double after_acceptance(double error) {
    constexpr double kLeast = 1e-10;  // limits the growth after an error of zero
    const double e = std::max(error, kLeast);
    const double r = root32(e);
    const double factor = safety_ * root32(previous_) / (r * r * r);
    previous_ = std::max(e, 1e-4);
    return std::clamp(factor, kShrinkMost, kGrowMost);
  }

  /// Returns the factor for a rejected step: error^(-1/8), without history.
  double after_rejection(double error) const {
    if (!(error < 1e30)) return kShrinkMost;
    const double r = root32(error);
    return std::clamp(safety_ / ((r * r) * (r * r)), kShrinkMost, safety_);
  }

  /// Returns the factor after a step of a method whose error is proportional to h^6: error^(-1/6), with 1/8 +
  /// 1/32 + 1/128 for the exponent.
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
