#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <span>
#include <utility>

#include "engine/math/interval.h"
#include "engine/scene/formula_functions.h"

/// Formulas over an interval of time: which of their comparisons, cases and pieces are decided by it. Between
/// two times at which none changes, a formula is smooth.
namespace plumb::formula {

/// The values of a part of a formula over an interval of time, and what is known of its decisions.
struct Ranged {
  Interval value{};
  bool of_motion = false;       ///< depends on the bodies' motion, so that no interval of time decides it
  bool undecided = false;       ///< some decision that depends on the time alone is not the same throughout
  std::uint64_t decisions = 0;  ///< a hash of all decisions

  constexpr Ranged() = default;
  constexpr Ranged(double number) : value(number) {}
  constexpr Ranged(Interval values) : value(values) {}
};

/// Returns a value that depends on others.
inline Ranged with(Interval value, const Ranged& a, const Ranged& b = {}) {
  Ranged out(value);
  out.of_motion = a.of_motion || b.of_motion, out.undecided = a.undecided || b.undecided;
  out.decisions = 31 * a.decisions + 17 * b.decisions;
  return out;
}

/// Records a decision of `out`, which is made (with a number for its outcome) or open.
inline Ranged decided(Ranged out, bool known, double outcome) {
  if (known) {
    out.decisions = 1099511628211u * out.decisions +
                    static_cast<std::uint64_t>(static_cast<std::int64_t>(std::clamp(outcome, -1e18, 1e18))) +
                    1;
  } else {
    out.undecided = out.undecided || !out.of_motion;
  }
  return out;
}

inline Ranged operator-(const Ranged& a) { return with(-a.value, a); }
inline Ranged operator+(const Ranged& a, const Ranged& b) { return with(a.value + b.value, a, b); }
inline Ranged operator-(const Ranged& a, const Ranged& b) { return with(a.value - b.value, a, b); }
inline Ranged operator*(const Ranged& a, const Ranged& b) { return with(a.value * b.value, a, b); }
inline Ranged operator/(const Ranged& a, const Ranged& b) { return with(a.value / b.value, a, b); }

/// Returns the values of a function that rises, or falls, all along. The functions of engine/math are
/// monotone but for roundings, which widen the interval.
template <class Function>
Ranged monotone(const Ranged& a, const Function& function) {
  const double f = function(a.value.low), g = function(a.value.high);
  if (a.value.is_number()) return with(f, a);
  constexpr double kRounding = 8 * std::numeric_limits<double>::epsilon();
  const double low = std::min(f, g), high = std::max(f, g);
  return with(Interval::checked({low - kRounding * std::abs(low), high + kRounding * std::abs(high)}), a);
}

inline Ranged sine(const Ranged& a) {
  if (a.value.is_number()) return with(sine(a.value.low), a);
  // Between the extremes at (k + 1/2) pi it is monotone.
  constexpr double kPi = std::numbers::pi;
  if (!(std::abs(a.value.low) < 1e15 && std::abs(a.value.high) < 1e15)) return with({-1, 1}, a);
  const double first = std::ceil(a.value.low / kPi - 0.5), last = std::floor(a.value.high / kPi - 0.5);
  Ranged out = monotone(a, [](double x) { return sine(x); });
  for (double k = first; k <= std::min(last, first + 1); ++k)
    (std::fmod(k, 2) == 0 ? out.value.high : out.value.low) = std::fmod(k, 2) == 0 ? 1 : -1;
  return out;
}
inline Ranged cosine(const Ranged& a) {
  if (a.value.is_number()) return with(cosine(a.value.low), a);
  Ranged out = sine(a + Ranged(std::numbers::pi / 2));
  constexpr double kRounding = 1e-15;  // of the sum
  out.value.low = std::max(out.value.low - kRounding * (1 + std::abs(a.value.low)), -1.0);
  out.value.high = std::min(out.value.high + kRounding * (1 + std::abs(a.value.high)), 1.0);
  return out;
}
inline Ranged tangent(const Ranged& a) {
  if (a.value.is_number()) return with(tangent(a.value.low), a);
  constexpr double kPi = std::numbers::pi;
  const bool pole = std::floor(a.value.low / kPi + 0.5) != std::floor(a.value.high / kPi + 0.5);
  return pole ? with(Interval::everything(), a) : monotone(a, [](double x) { return tangent(x); });
}
inline Ranged arc_sine(const Ranged& a) {
  return monotone(a, [](double x) { return arc_sine(x); });
}
inline Ranged arc_cosine(const Ranged& a) {
  return monotone(a, [](double x) { return arc_cosine(x); });
}
inline Ranged arc_tangent_of(const Ranged& a) {
  return monotone(a, [](double x) { return arc_tangent_of(x); });
}
inline Ranged exponential_of(const Ranged& a) {
  return monotone(a, [](double x) { return exponential_of(x); });
}
inline Ranged logarithm_of(const Ranged& a, double unit) {
  return monotone(a, [&](double x) { return logarithm_of(x, unit); });
}
inline Ranged sqrt_of(const Ranged& a) {
  return monotone(a, [](double x) { return sqrt_of(x); });
}
inline Ranged sinh_of(const Ranged& a) {
  return monotone(a, [](double x) { return sinh_of(x); });
}
inline Ranged cosh_of(const Ranged& a) {
  Ranged out = monotone(a, [](double x) { return cosh_of(x); });
  if (a.value.contains(0)) out.value.low = 1;
  return out;
}
inline Ranged tanh_of(const Ranged& a) {
  return monotone(a, [](double x) { return tanh_of(x); });
}
/// An angle, with a cut where x < 0 and y = 0.
inline Ranged arc_tangent_of(const Ranged& y, const Ranged& x) {
  if (y.value.is_number() && x.value.is_number()) return with(arc_tangent_of(y.value.low, x.value.low), y, x);
  const Ranged out = with({-std::numbers::pi, std::numbers::pi}, y, x);
  const bool above = y.value.low > 0, below = y.value.high<0, right = x.value.low> 0;
  return decided(out, above || below || right, right ? 0 : above ? 1 : -1);
}
/// Monotone in each argument where the base is positive.
inline Ranged power_of(const Ranged& a, const Ranged& b) {
  const Interval x = a.value, n = b.value;
  if (x.is_number() && n.is_number()) return with(power_of(x.low, n.low), a, b);
  const bool whole = n.is_number() && n.low == std::floor(n.low);
  if (!(x.low > 0) && !(whole && n.low > 0)) return with(Interval::everything(), a, b);
  Interval out = Interval::hull(power_of(x.low, n.low), power_of(x.low, n.high), power_of(x.high, n.low),
                                power_of(x.high, n.high));
  if (x.contains(0)) out.low = std::min(out.low, 0.0), out.high = std::max(out.high, 0.0);
  return with(out, a, b);
}

// Decisions.

inline Ranged less(const Ranged& a, const Ranged& b) {
  const bool yes = a.value.high < b.value.low, no = a.value.low >= b.value.high;
  return decided(with(yes ? Interval(1) : no ? Interval(0) : Interval(0, 1), a, b), yes || no, yes);
}
inline Ranged opposite(const Ranged& a) {
  return with(!a.value.contains(0) ? Interval(0) : a.value.is_number() ? Interval(1) : Interval(0, 1), a);
}
inline Ranged at_most(const Ranged& a, const Ranged& b) { return opposite(less(b, a)); }
inline Ranged equal(const Ranged& a, const Ranged& b) {
  const bool yes = a.value.is_number() && b.value.is_number() && a.value.low == b.value.low,
             no = a.value.high < b.value.low || b.value.high < a.value.low;
  return decided(with(yes ? Interval(1) : no ? Interval(0) : Interval(0, 1), a, b), yes || no, yes);
}
inline Ranged both(const Ranged& a, const Ranged& b) {
  const bool yes = !a.value.contains(0) && !b.value.contains(0);
  const bool no = (a.value.is_number() && a.value.low == 0) || (b.value.is_number() && b.value.low == 0);
  return with(yes ? Interval(1) : no ? Interval(0) : Interval(0, 1), a, b);
}
inline Ranged select(const Ranged& condition, const Ranged& yes, const Ranged& no) {
  const auto chosen = [&](const Ranged& branch) { return with(branch.value, branch, condition); };
  if (!condition.value.contains(0)) return chosen(yes);
  if (condition.value.is_number()) return chosen(no);
  const Interval either{std::min(yes.value.low, no.value.low), std::max(yes.value.high, no.value.high)};
  return with(either, with({}, yes, no), condition);
}
inline Ranged smaller(const Ranged& a, const Ranged& b) {
  const Interval out{std::min(a.value.low, b.value.low), std::min(a.value.high, b.value.high)};
  const bool first = a.value.high <= b.value.low, second = b.value.high < a.value.low;
  return decided(with(out, a, b), first || second, first);
}
inline Ranged larger(const Ranged& a, const Ranged& b) { return -smaller(-a, -b); }
inline Ranged absolute(const Ranged& a) { return -smaller(a, -a); }
inline Ranged sign_of(const Ranged& a) { return less(Ranged(0.0), a) - less(a, Ranged(0.0)); }
inline Ranged floor_of(const Ranged& a) {
  const double low = std::floor(a.value.low), high = std::floor(a.value.high);
  return decided(with(Interval::checked({low, high}), a), low == high, low);
}
inline Ranged modulo_of(const Ranged& a, const Ranged& b) { return a - b * floor_of(a / b); }

inline Ranged through_points(const Ranged& x, std::span<const Point> points) {
  // The first point belongs to the constant before it.
  const auto piece_of = [&](double at) {
    if (at == points.front().x) return std::ptrdiff_t{0};
    return std::upper_bound(points.begin(), points.end(), at,
                            [](double value, const Point& p) { return value < p.x; }) -
           points.begin();
  };
  const auto first = piece_of(x.value.low), last = piece_of(x.value.high);
  const auto value_at = [&](double at) { return through_points(at, points); };
  double low = value_at(x.value.low), high = value_at(x.value.high);
  if (low > high) std::swap(low, high);
  for (auto i = first; i < last; ++i) low = std::min(low, points[i].y), high = std::max(high, points[i].y);
  return decided(with({low, high}, x), first == last, static_cast<double>(first));
}

}  // namespace plumb::formula
