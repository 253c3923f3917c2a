#pragma once

#include <algorithm>
#include <cmath>
#include <span>

#include "engine/math/arc_tangent.h"
#include "engine/math/exponential.h"
#include "engine/math/hyperbolic.h"
#include "engine/math/jet.h"
#include "engine/math/trigonometry.h"
#include "engine/scene/formula.h"

/// Functions that a formula may call, for a number or for a jet.
namespace plumb::formula {

inline double value_of(double a) { return a; }
inline double value_of(const Jet& a) { return a.value; }

inline double through(double, double f, double, double) { return f; }

// Functions of a number or a jet: the value, and for a jet the first two derivatives.
template <class V>
V sine(V a) {
  const Rotation<double> rotation = rotation_of(value_of(a));
  return through(a, rotation.s, rotation.c, -rotation.s);
}
template <class V>
V cosine(V a) {
  const Rotation<double> rotation = rotation_of(value_of(a));
  return through(a, rotation.c, -rotation.s, -rotation.c);
}
template <class V>
V tangent(V a) {
  const Rotation<double> rotation = rotation_of(value_of(a));
  const double tan = rotation.s / rotation.c, slope = 1 + tan * tan;
  return through(a, tan, slope, 2 * tan * slope);
}
template <class V>
V arc_sine(V a) {
  const double x = value_of(a), one_minus_square = (1 - x) * (1 + x), root = std::sqrt(one_minus_square);
  return through(a, one_minus_square < 0 ? root : arc_tangent(x, root), 1 / root,
                 x / (one_minus_square * root));
}
template <class V>
V arc_cosine(V a) {
  const double x = value_of(a), one_minus_square = (1 - x) * (1 + x), root = std::sqrt(one_minus_square);
  return through(a, one_minus_square < 0 ? root : arc_tangent(root, x), -1 / root,
                 -x / (one_minus_square * root));
}
template <class V>
V arc_tangent_of(V a) {
  const double x = value_of(a), slope = 1 / (1 + x * x);
  return through(a, arc_tangent(x, 1), slope, -2 * x * slope * slope);
}
template <class V>
V exponential_of(V a) {
  const double grown = exponential(value_of(a));
  return through(a, grown, grown, grown);
}
template <class V>
V logarithm_of(V a, double unit) {
  const double x = value_of(a);
  return through(a, logarithm(x) / unit, 1 / (unit * x), -1 / (unit * x * x));
}
// At 0 the slope is taken as 0, so that sqrt(x^2 + y^2) has a derivative everywhere.
template <class V>
V sqrt_of(V a) {
  const double root = std::sqrt(value_of(a));
  const double slope = root > 0 ? 0.5 / root : 0;
  return through(a, root, slope, root > 0 ? -0.5 * slope / (root * root) : 0);
}
template <class V>
V sinh_of(V a) {
  const double s = hyperbolic_sine(value_of(a)), c = hyperbolic_cosine(value_of(a));
  return through(a, s, c, s);
}
template <class V>
V cosh_of(V a) {
  const double s = hyperbolic_sine(value_of(a)), c = hyperbolic_cosine(value_of(a));
  return through(a, c, s, c);
}
template <class V>
V tanh_of(V a) {
  const double t = hyperbolic_tangent(value_of(a)), slope = 1 - t * t;
  return through(a, t, slope, -2 * t * slope);
}

inline double arc_tangent_of(double y, double x) { return arc_tangent(y, x); }
// d atan2(y, x) = (x dy - y dx) / r^2.
inline Jet arc_tangent_of(Jet y, Jet x) {
  const Jet slope = (x * Jet(y.first, y.second) - y * Jet(x.first, x.second)) / (x * x + y * y);
  return {arc_tangent(y.value, x.value), slope.value, slope.first};
}

inline double power_of(double a, double b) { return power(a, b); }
inline Jet power_of(Jet a, Jet b) {
  const double value = power(a.value, b.value);
  if (b.first == 0 && b.second == 0) {
    const double n = b.value;
    const double slope = n == 0 ? 0 : n * power(a.value, n - 1);
    const double second = n == 0 || n == 1 ? 0 : n * (n - 1) * power(a.value, n - 2);
    return through(a, value, slope, second);
  }
  Jet grown = exponential_of(b * logarithm_of(a, 1));
  grown.value = value;
  return grown;
}

inline double modulo_of(double a, double b) { return a - b * std::floor(a / b); }
inline Jet modulo_of(Jet a, Jet b) { return a - b * Jet(std::floor(a.value / b.value)); }

// Decisions: comparisons, cases and pieces.

template <class V>
V less(const V& a, const V& b) {
  return V(value_of(a) < value_of(b) ? 1.0 : 0.0);
}
template <class V>
V at_most(const V& a, const V& b) {
  return V(value_of(a) <= value_of(b) ? 1.0 : 0.0);
}
template <class V>
V equal(const V& a, const V& b) {
  return V(value_of(a) == value_of(b) ? 1.0 : 0.0);
}
template <class V>
V opposite(const V& a) {
  return V(value_of(a) != 0 ? 0.0 : 1.0);
}
template <class V>
V both(const V& a, const V& b) {
  return V(value_of(a) != 0 && value_of(b) != 0 ? 1.0 : 0.0);
}
template <class V>
V select(const V& condition, const V& yes, const V& no) {
  return value_of(condition) != 0 ? yes : no;
}
template <class V>
V smaller(const V& a, const V& b) {
  return value_of(b) < value_of(a) ? b : a;
}
template <class V>
V larger(const V& a, const V& b) {
  return value_of(b) > value_of(a) ? b : a;
}
template <class V>
V absolute(const V& a) {
  return value_of(a) < 0 ? -a : a;
}
template <class V>
V sign_of(const V& a) {
  return V(value_of(a) > 0 ? 1.0 : value_of(a) < 0 ? -1.0 : 0.0);
}
template <class V>
V floor_of(const V& a) {
  return V(std::floor(value_of(a)));
}

/// Returns the value at x of straight lines through points with ascending x, constant beyond the ends.
template <class V>
V through_points(const V& at, std::span<const Point> points) {
  const double x = value_of(at);
  if (!(x > points.front().x)) return V(std::isnan(x) ? x : points.front().y);
  if (x >= points.back().x) return V(points.back().y);
  const auto next = std::upper_bound(points.begin(), points.end(), x,
                                     [](double value, const Point& p) { return value < p.x; });
  const Point& from = next[-1];
  const double slope = (next->y - from.y) / (next->x - from.x);
  return through(at, from.y + slope * (x - from.x), slope, 0);
}

}  // namespace plumb::formula
