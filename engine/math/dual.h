#pragma once

#include <cmath>

namespace plumb {

/// A number with its derivative along one direction: templates on Real compute exact derivatives with it (W.
/// K. Clifford 1873; R. E. Wengert, A simple automatic derivative evaluation program, CACM 7, 1964).
struct Dual {
  double value = 0, change = 0;

  constexpr Dual() = default;
  constexpr Dual(double number, double derivative = 0) : value(number), change(derivative) {}

  constexpr Dual& operator+=(Dual b) { return *this = *this + b; }
  constexpr Dual& operator-=(Dual b) { return *this = *this - b; }
  constexpr Dual& operator*=(Dual b) { return *this = *this * b; }

  friend constexpr Dual operator-(Dual a) { return {-a.value, -a.change}; }
  friend constexpr Dual operator+(Dual a, Dual b) { return {a.value + b.value, a.change + b.change}; }
  friend constexpr Dual operator-(Dual a, Dual b) { return {a.value - b.value, a.change - b.change}; }
  friend constexpr Dual operator*(Dual a, Dual b) {
    return {a.value * b.value, a.change * b.value + a.value * b.change};
  }
  friend constexpr Dual operator/(Dual a, Dual b) {
    const double quotient = a.value / b.value;
    return {quotient, (a.change - quotient * b.change) / b.value};
  }
  friend Dual sqrt(Dual a) {
    const double root = std::sqrt(a.value);
    return {root, root > 0 ? 0.5 * a.change / root : 0};
  }

  friend constexpr bool operator==(Dual a, Dual b) { return a.value == b.value; }
  friend constexpr bool operator<(Dual a, Dual b) { return a.value < b.value; }
  friend constexpr bool operator>(Dual a, Dual b) { return a.value > b.value; }
};

}  // namespace plumb
