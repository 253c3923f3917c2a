#pragma once

namespace plumb {

/// A number with its first and second derivative along one direction: a Taylor polynomial cut off after its
/// square (R. D. Neidinger, Introduction to Automatic Differentiation, SIAM Review 52, 2010).
struct Jet {
  double value = 0, first = 0, second = 0;

  constexpr Jet() = default;
  constexpr Jet(double number, double derivative = 0, double derivative_of_that = 0)
      : value(number), first(derivative), second(derivative_of_that) {}

  friend constexpr Jet operator-(Jet a) { return {-a.value, -a.first, -a.second}; }
  friend constexpr Jet operator+(Jet a, Jet b) {
    return {a.value + b.value, a.first + b.first, a.second + b.second};
  }
  friend constexpr Jet operator-(Jet a, Jet b) {
    return {a.value - b.value, a.first - b.first, a.second - b.second};
  }
  friend constexpr Jet operator*(Jet a, Jet b) {
    return {a.value * b.value, a.first * b.value + a.value * b.first,
            a.second * b.value + 2 * (a.first * b.first) + a.value * b.second};
  }
  // From a = q b, differentiated twice.
  friend constexpr Jet operator/(Jet a, Jet b) {
    const double q = a.value / b.value, slope = (a.first - q * b.first) / b.value;
    return {q, slope, (a.second - 2 * (slope * b.first) - q * b.second) / b.value};
  }

  /// Returns f(a), given f, f' and f'' at the value of a.
  friend constexpr Jet through(Jet a, double f, double slope, double curve) {
    return {f, slope * a.first, curve * (a.first * a.first) + slope * a.second};
  }
};

}  // namespace plumb
