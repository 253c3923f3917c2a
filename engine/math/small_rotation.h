#pragma once

#include <cmath>

#include "engine/math/trigonometry.h"

namespace plumb {

/// Rotates `q` by `x`, rad. Up to an eighth of a radian, uses a series for sine and cosine with the rounding
/// error of a float; beyond that, `rotation_of`.
template <class Real>
[[gnu::always_inline]] inline Rotation<Real> rotated_by(Rotation<Real> q, Real x) {
  if (std::abs(x) > Real(0.125)) {
    const Rotation<Real> r = rotation_of(x);
    return {q.c * r.c - q.s * r.s, q.s * r.c + q.c * r.s};
  }
  const Real x2 = x * x;
  const Real s = x * (1 - x2 * (Real(1) / 6) * (1 - x2 * (Real(1) / 20) * (1 - x2 * (Real(1) / 42))));
  const Real c = 1 - x2 * Real(0.5) * (1 - x2 * (Real(1) / 12) * (1 - x2 * (Real(1) / 30)));
  return {q.c * c - q.s * s, q.s * c + q.c * s};
}

}  // namespace plumb
