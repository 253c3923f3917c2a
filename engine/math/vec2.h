#pragma once

// Uses the compiler's own square root if it has one: including <cmath> would double the cost of including a
// public header.
#ifndef __GNUC__
#include <cmath>
#endif

namespace plumb {

/// A vector in the plane. Units are those of the quantity it holds. Always inlined: for vectors of Lanes,
/// functions compiled for different register widths pass them differently.
template <class Real>
struct Vec2 {
  Real x = 0, y = 0;

  friend constexpr bool operator==(const Vec2&, const Vec2&) = default;

  [[gnu::always_inline]] constexpr Vec2& operator+=(Vec2 b) { return x += b.x, y += b.y, *this; }
  [[gnu::always_inline]] constexpr Vec2& operator-=(Vec2 b) { return x -= b.x, y -= b.y, *this; }
  [[gnu::always_inline]] constexpr Vec2& operator*=(Real s) { return x *= s, y *= s, *this; }

  [[gnu::always_inline]] friend constexpr Vec2 operator+(Vec2 a, Vec2 b) { return {a.x + b.x, a.y + b.y}; }
  [[gnu::always_inline]] friend constexpr Vec2 operator-(Vec2 a, Vec2 b) { return {a.x - b.x, a.y - b.y}; }
  [[gnu::always_inline]] friend constexpr Vec2 operator-(Vec2 a) { return {-a.x, -a.y}; }
  [[gnu::always_inline]] friend constexpr Vec2 operator*(Real s, Vec2 a) { return {s * a.x, s * a.y}; }
  [[gnu::always_inline]] friend constexpr Vec2 operator*(Vec2 a, Real s) { return s * a; }

  template <class To>
  constexpr Vec2<To> as() const {
    return {static_cast<To>(x), static_cast<To>(y)};
  }
};

using Vec2d = Vec2<double>;

template <class Real>
[[gnu::always_inline]] constexpr Real dot(Vec2<Real> a, Vec2<Real> b) {
  return a.x * b.x + a.y * b.y;
}

/// Returns the z component of a x b.
template <class Real>
[[gnu::always_inline]] constexpr Real cross(Vec2<Real> a, Vec2<Real> b) {
  return a.x * b.y - a.y * b.x;
}

/// Returns w z-hat x r: the velocity at r of a body with angular velocity w.
template <class Real>
[[gnu::always_inline]] constexpr Vec2<Real> cross(Real w, Vec2<Real> r) {
  return {-w * r.y, w * r.x};
}

template <class Real>
[[gnu::always_inline]] constexpr Real length_squared(Vec2<Real> a) {
  return dot(a, a);
}

template <class Real>
[[gnu::always_inline]] inline Real length(Vec2<Real> a) {
#ifdef __GNUC__
  static_assert(sizeof(Real) <= sizeof(double));
  if constexpr (sizeof(Real) == sizeof(float)) return __builtin_sqrtf(length_squared(a));
  return __builtin_sqrt(length_squared(a));
#else
  return std::sqrt(length_squared(a));
#endif
}

/// Rotates a by a quarter turn counter-clockwise.
template <class Real>
[[gnu::always_inline]] constexpr Vec2<Real> perpendicular(Vec2<Real> a) {
  return {-a.y, a.x};
}

/// A rotation held as the cosine and sine of its angle.
template <class Real>
struct Rotation {
  Real c = 1, s = 0;

  /// Rotates from the body's frame to the world's.
  friend constexpr Vec2<Real> operator*(Rotation q, Vec2<Real> v) {
    return {q.c * v.x - q.s * v.y, q.s * v.x + q.c * v.y};
  }
  constexpr Rotation inverse() const { return {c, -s}; }
};

}  // namespace plumb
