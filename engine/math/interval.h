#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace plumb {

/// All numbers between two ends (R. E. Moore, Interval Analysis, 1966). The result of an operation contains
/// every result for numbers of its operands; it may be wider.
struct Interval {
  double low = 0, high = 0;

  constexpr Interval() = default;
  constexpr Interval(double number) : low(number), high(number) {}
  constexpr Interval(double from, double to) : low(from), high(to) {}

  static constexpr Interval everything() {
    return {-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  }
  constexpr bool is_number() const { return low == high; }
  constexpr bool contains(double x) const { return low <= x && x <= high; }

  friend constexpr Interval operator-(Interval a) { return {-a.high, -a.low}; }
  friend constexpr Interval operator+(Interval a, Interval b) {
    return checked({a.low + b.low, a.high + b.high});
  }
  friend constexpr Interval operator-(Interval a, Interval b) { return a + -b; }
  friend constexpr Interval operator*(Interval a, Interval b) {
    if ((a.is_number() && a.low == 0) || (b.is_number() && b.low == 0)) return 0;
    return hull(a.low * b.low, a.low * b.high, a.high * b.low, a.high * b.high);
  }
  friend constexpr Interval operator/(Interval a, Interval b) {
    if (b.contains(0)) return everything();
    return hull(a.low / b.low, a.low / b.high, a.high / b.low, a.high / b.high);
  }

  /// Returns the interval of four corners.
  static constexpr Interval hull(double a, double b, double c, double d) {
    if (!(a == a && b == b && c == c && d == d)) return everything();
    return {std::min(std::min(a, b), std::min(c, d)), std::max(std::max(a, b), std::max(c, d))};
  }
  /// Returns everything in place of ends that are not numbers.
  static constexpr Interval checked(Interval a) { return a.low <= a.high ? a : everything(); }
};

}  // namespace plumb
