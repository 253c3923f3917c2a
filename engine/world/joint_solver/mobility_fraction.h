#pragma once

#include <algorithm>
#include <cmath>

#include "engine/world/joint_solver/joint_point.h"
#include "engine/world/joint_solver/joint_velocities.h"

namespace plumb {

/// Largest fraction of a joint's mobility that is body a's, and b's, over all combinations of its rows: the
/// largest eigenvalue of K^-1 K_a, K = K_a + K_b = J M^-1 J^T; 0 to 1. The trace would mix rotation and
/// translation: if a long blade is welded to a small hub, the hub has 0.92 of the mobility in the stiffest
/// direction, but 0.5 of the trace.
template <class Real>
struct MobilityFraction {
  Real a = 0, b = 0;
};

/// Returns the fractions of a point, whose two rows have a closed form.
template <class Real>
[[gnu::always_inline]] inline MobilityFraction<Real> point_mobility_fraction(const JointVelocities<Real>& v,
                                                                             Vec2<Real> arm_a,
                                                                             Vec2<Real> arm_b) {
  const PointResponse<Real> k = point_response(v, arm_a, arm_b);
  if (!(k.determinant > 0))
    return {v.m_a + v.i_a > 0 ? Real(1) : Real(0), v.m_b + v.i_b > 0 ? Real(1) : Real(0)};
  const Real a_xx = v.m_a + v.i_a * (arm_a.y * arm_a.y), a_yy = v.m_a + v.i_a * (arm_a.x * arm_a.x),
             a_xy = -v.i_a * (arm_a.x * arm_a.y);
  // Entries of K^-1 K_a as differences: exact to rounding for equal bodies.
  const Real s_xx = (k.yy * a_xx - k.xy * a_xy) / k.determinant,
             s_yy = (k.xx * a_yy - k.xy * a_xy) / k.determinant;
  const Real s_xy = (k.yy * a_xy - k.xy * a_yy) / k.determinant,
             s_yx = (k.xx * a_xy - k.xy * a_xx) / k.determinant;
  const Real mean = Real(0.5) * (s_xx + s_yy), half = Real(0.5) * (s_xx - s_yy);
  const Real difference = std::sqrt(std::max(half * half + s_xy * s_yx, Real(0)));
  const auto fraction = [](Real value) { return std::min(std::max(value, Real(0)), Real(1)); };
  return {fraction(mean + difference), fraction(1 - (mean - difference))};
}

/// Returns the fractions of any rows. Redundant rows count once.
template <class Real, int N>
MobilityFraction<Real> mobility_fraction(const JointRow<Real> (&rows)[N], const JointVelocities<Real>& v) {
  static_assert(N <= 3, "two bodies move against each other in three ways");
  double k[N][N], fraction[N][N];  // J M^-1 J^T; of a
  for (int i = 0; i < N; ++i) {
    for (int j = 0; j <= i; ++j) {
      const JointRow<Real>&r = rows[i], &s = rows[j];
      const double of_a = v.m_a * dot(r.linear_a, s.linear_a) + v.i_a * (r.angular_a * s.angular_a);
      const double of_b = v.m_b * dot(r.linear_b, s.linear_b) + v.i_b * (r.angular_b * s.angular_b);
      fraction[i][j] = fraction[j][i] = of_a;
      k[i][j] = k[j][i] = of_a + of_b;
    }
  }
  // Gauss-Jordan elimination turns `fraction` into S = K^-1 K_a. Rows that depend on those before them are
  // left out.
  double diagonal[N];
  for (int i = 0; i < N; ++i) diagonal[i] = k[i][i];
  int rank = 0;
  for (int i = 0; i < N; ++i) {
    // Fraction of the diagonal up to which a pivot is rounding: the diagonal has single precision.
    constexpr double kPivotTolerance = 1e-6;
    const bool independent = k[i][i] > kPivotTolerance * diagonal[i];
    const double inverse = independent ? 1 / k[i][i] : 0;
    rank += independent ? 1 : 0;
    for (int j = i + 1; j < N; ++j) k[i][j] *= inverse;
    for (int j = 0; j < N; ++j) fraction[i][j] *= inverse;
    for (int row = 0; row < N; ++row) {
      if (row == i) continue;
      const double factor = k[row][i];
      for (int j = i + 1; j < N; ++j) k[row][j] -= factor * k[i][j];
      for (int j = 0; j < N; ++j) fraction[row][j] -= factor * fraction[i][j];
    }
  }
  double first = 0, second = 0, third = 0;  // elementary symmetric sums of the eigenvalues of S
  for (int i = 0; i < N; ++i) {
    first += fraction[i][i];
    for (int j = 0; j < i; ++j) second += fraction[i][i] * fraction[j][j] - fraction[i][j] * fraction[j][i];
  }
  if constexpr (N == 3) {
    const auto minor = [&fraction](int i, int j) {
      return fraction[1][i] * fraction[2][j] - fraction[1][j] * fraction[2][i];
    };
    third = fraction[0][0] * minor(1, 2) - fraction[0][1] * minor(0, 2) + fraction[0][2] * minor(0, 1);
  }
  // Squares all eigenvalues four times (Dandelin and Graeffe's method): the sum of their 16th powers is
  // within a root of 1.07 of the largest. Relative to their sum, so that nothing is lost of small ones.
  const auto largest = [](double sum, double pairs, double product) {
    if (!(sum > 0)) return Real(0);
    double a = 1, b = pairs / (sum * sum), c = product / (sum * sum * sum);
    for (int squaring = 0; squaring < 4; ++squaring) {
      const double next = a * a - 2 * b;
      b = b * b - 2 * a * c, c = c * c, a = next;
    }
    for (int root = 0; root < 4; ++root) a = std::sqrt(std::max(a, 0.0));
    return static_cast<Real>(std::min(sum * a, 1.0));
  };
  // The eigenvalues of K^-1 K_b are 1 minus these, except for rows left out.
  const double n = rank, of_three = rank == 3 ? 1 - first + second - third : 0;
  return {largest(first, second, third),
          largest(n - first, n * (n - 1) / 2 - (n - 1) * first + second, of_three)};
}

}  // namespace plumb
