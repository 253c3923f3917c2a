#pragma once

#include <array>
#include <cstddef>
#include <optional>

/// Polynomials on [0, 1] by their Bernstein coefficients. Their values lie between the least and the largest
/// coefficient, so that no root is missed.
namespace plumb {

template <std::size_t N>
using Bernstein = std::array<double, N>;  // degree N - 1

/// Computes the two halves' coefficients (de Casteljau's algorithm).
template <std::size_t N>
void halve(const Bernstein<N>& whole, Bernstein<N>& left, Bernstein<N>& right) {
  right = whole;
  for (std::size_t level = 0; level < N; ++level) {
    left[level] = right[0];
    for (std::size_t i = 0; i + 1 < N - level; ++i) right[i] = 0.5 * (right[i] + right[i + 1]);
  }
}

/// Returns the only root of a polynomial that is positive at `low` and not at `high`.
template <std::size_t N>
double single_down_crossing(Bernstein<N> c, double low, double high) {
  Bernstein<N> left{}, right{};
  for (double middle = 0.5 * (low + high); low < middle && middle < high; middle = 0.5 * (low + high)) {
    halve(c, left, right);
    const bool root_is_later = right[0] > 0;
    c = root_is_later ? right : left;
    (root_is_later ? low : high) = middle;
    if (high - low < 1e-17) break;
  }
  return high;
}

/// Returns the first s in [low, high] at which the polynomial, given by its coefficients on that interval,
/// changes from positive to not positive. Two roots closer together than 2^-`depth` are ignored.
template <std::size_t N>
std::optional<double> first_down_crossing(const Bernstein<N>& c, double low = 0, double high = 1,
                                          int depth = 40) {
  // By Descartes' rule there are at most as many roots as sign changes among the coefficients; one change is
  // exactly one root.
  int changes = 0;
  for (std::size_t i = 1; i < N; ++i) changes += (c[i] > 0) != (c[i - 1] > 0) ? 1 : 0;
  if (changes == 1 && c[0] > 0) return single_down_crossing(c, low, high);
  if (changes <= 1 || depth == 0) return std::nullopt;
  const double middle = 0.5 * (low + high);
  Bernstein<N> left{}, right{};
  halve(c, left, right);
  if (const auto root = first_down_crossing(left, low, middle, depth - 1)) return root;
  return first_down_crossing(right, middle, high, depth - 1);
}

}  // namespace plumb
