#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace plumb {

/// Accumulators for many small increments. The rounding error of each addition is carried into the next, so
/// that the error does not grow with the number of steps (Kahan 1965; the exact error is Knuth's TwoSum).
class Compensated {
 public:
  explicit Compensated(std::size_t size = 0) : value_(size, 0.0), carry_(size, 0.0) {}

  std::size_t size() const { return value_.size(); }
  std::span<const double> value() const { return value_; }
  std::span<const double> carry() const { return carry_; }
  double operator[](std::size_t i) const { return value_[i]; }

  void set(std::size_t i, double value, double carry = 0) {
    value_[i] = value;
    carry_[i] = carry;
  }

  void add(std::size_t i, double increment) {
    if (increment == 0) return;
    const double a = value_[i], b = increment + carry_[i];
    const double sum = a + b;
    const double b_seen = sum - a;
    carry_[i] = (a - (sum - b_seen)) + (b - b_seen);
    value_[i] = sum;
  }

 private:
  std::vector<double> value_, carry_;
};

}  // namespace plumb
