#pragma once

#include <algorithm>
#include <cmath>

#include "engine/world/joint_solver/joint_point.h"
#include "engine/world/joint_solver/joint_velocities.h"

namespace plumb {

/// Largest fraction of a joint's mobility that is body a's, and b's, over all combinations of its rows: the
/// largest eigenvalue of K^-1 K_a, K = K_a + K_b = J M^-1 J^T; 0 to 1. Traces would mix rotation and
/// translation. For a long blade welded to a small hub, the hub has 0.92 of the mobility in the stiffest
/// direction, and 0.5 in the trace.
template <class Real>
struct JointLoad {
  Real a = 0, b = 0;
};

/// Returns the load of a point, whose two rows have a closed form.
template <class Real>
[[gnu::always_inline]] inline JointLoad<Real> point_load(const JointVelocities<Real>& v, Vec2<Real> arm_a,
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
  const Real apart = std::sqrt(std::max(half * half + s_xy * s_yx, Real(0)));
  const auto share = [](Real value) { return std::min(std::max(value, Real(0)), Real(1)); };
  return {share(mean + apart), share(1 - (mean - apart))};
}

/// Returns the load of any rows. Redundant rows count once.
template <class Real, int N>
JointLoad<Real> joint_load(const JointRow<Real> (&rows)[N], const JointVelocities<Real>& v) {
  double k[N][N], part[2][N][N];  // J M^-1 J^T; of a and b
  for (int i = 0; i < N; ++i) {
    for (int j = 0; j < N; ++j) {
      const JointRow<Real>&r = rows[i], &s = rows[j];
      part[0][i][j] = v.m_a * dot(r.linear_a, s.linear_a) + v.i_a * (r.angular_a * s.angular_a);
      part[1][i][j] = v.m_b * dot(r.linear_b, s.linear_b) + v.i_b * (r.angular_b * s.angular_b);
      k[i][j] = part[0][i][j] + part[1][i][j];
    }
  }
  // Gauss-Jordan elimination turns the parts into K^-1 K_a and K^-1 K_b. Rows that depend on those before
  // them are left out.
  double diagonal[N];
  for (int i = 0; i < N; ++i) diagonal[i] = k[i][i];
  for (int i = 0; i < N; ++i) {
    constexpr double kNothing = 1e-6;  // of the diagonal, which has single precision
    const double inverse = k[i][i] > kNothing * diagonal[i] ? 1 / k[i][i] : 0;
    for (int j = 0; j < N; ++j) k[i][j] *= inverse, part[0][i][j] *= inverse, part[1][i][j] *= inverse;
    for (int row = 0; row < N; ++row) {
      if (row == i) continue;
      const double factor = k[row][i];
      for (int j = 0; j < N; ++j) {
        k[row][j] -= factor * k[i][j];
        part[0][row][j] -= factor * part[0][i][j], part[1][row][j] -= factor * part[1][i][j];
      }
    }
  }
  // The trace of the 16th power is the sum of the eigenvalues' 16th powers: within 7 % of the largest.
  const auto largest = [](double(&s)[N][N]) {
    for (int squaring = 0; squaring < 4; ++squaring) {
      double t[N][N]{};
      for (int i = 0; i < N; ++i)
        for (int j = 0; j < N; ++j)
          for (int m = 0; m < N; ++m) t[i][j] += s[i][m] * s[m][j];
      std::copy(&t[0][0], &t[0][0] + N * N, &s[0][0]);
    }
    double sum = 0;
    for (int i = 0; i < N; ++i) sum += s[i][i];
    for (int root = 0; root < 4; ++root) sum = std::sqrt(std::max(sum, 0.0));
    return static_cast<Real>(std::min(sum, 1.0));
  };
  return {largest(part[0]), largest(part[1])};
}

}  // namespace plumb
