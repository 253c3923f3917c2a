#pragma once

#include <algorithm>
#include <cmath>

#include "engine/solve/joint_velocities.h"

namespace plumb {

/// From how many joints of one body on the share of a joint is looked at.
inline constexpr int kManyJoints = 3;

/// How much of what a joint's rows give way by is a body's, at the most along any combination of them: the
/// largest eigenvalue of (J M^-1 J^T)^-1 J_a M_a^-1 J_a^T, and the same of b; 0 to 1. Traces would add what
/// turns to what moves: of a long blade welded to a small hub the hub gives way by 0.92 of all in the
/// stiffest direction, and by 0.5 in the trace.
template <class Real>
struct JointLoad {
  Real a = 0, b = 0;
};

/// Of a point, whose two rows have a closed form.
template <class Real>
[[gnu::always_inline]] inline JointLoad<Real> point_load(const JointVelocities<Real>& v, Vec2<Real> arm_a,
                                                         Vec2<Real> arm_b) {
  const Real a_xx = v.m_a + v.i_a * (arm_a.y * arm_a.y), a_yy = v.m_a + v.i_a * (arm_a.x * arm_a.x),
             a_xy = -v.i_a * (arm_a.x * arm_a.y);
  const Real xx = a_xx + v.m_b + v.i_b * (arm_b.y * arm_b.y), yy = a_yy + v.m_b + v.i_b * (arm_b.x * arm_b.x),
             xy = a_xy - v.i_b * (arm_b.x * arm_b.y);
  const Real determinant = xx * yy - xy * xy;
  if (!(determinant > 0))
    return {v.m_a + v.i_a > 0 ? Real(1) : Real(0), v.m_b + v.i_b > 0 ? Real(1) : Real(0)};
  // The matrix' entries as differences: of equal bodies nothing is left apart, to rounding.
  const Real b_xx = (yy * a_xx - xy * a_xy) / determinant, b_yy = (xx * a_yy - xy * a_xy) / determinant;
  const Real b_xy = (yy * a_xy - xy * a_yy) / determinant, b_yx = (xx * a_xy - xy * a_xx) / determinant;
  const Real mean = Real(0.5) * (b_xx + b_yy), half = Real(0.5) * (b_xx - b_yy);
  const Real apart = std::sqrt(std::max(half * half + b_xy * b_yx, Real(0)));
  return {mean + apart, 1 - (mean - apart)};
}

/// Of any rows. What rows say twice counts once.
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
  // K = L D L^T; a row that those before it leave nothing of is left out.
  double lower[N][N]{}, inverse[N]{};
  for (int i = 0; i < N; ++i) {
    for (int j = 0; j <= i; ++j) {
      double sum = k[i][j];
      for (int m = 0; m < j; ++m)
        if (inverse[m] > 0) sum -= lower[i][m] * lower[j][m] / inverse[m];
      if (j < i) {
        lower[i][j] = sum * inverse[j];
      } else {
        constexpr double kNothing = 1e-6;  // of the diagonal, which is single precision's
        inverse[i] = sum > kNothing * k[i][i] ? 1 / sum : 0;
      }
    }
  }
  const auto largest = [&](const double(&own)[N][N]) {
    // D^-1/2 L^-1 K_a L^-T D^-1/2 has the same eigenvalues, and is symmetric.
    double s[N][N], t[N][N];
    for (int column = 0; column < N; ++column) {
      for (int i = 0; i < N; ++i) {
        double sum = own[i][column];
        for (int m = 0; m < i; ++m) sum -= lower[i][m] * s[m][column];
        s[i][column] = sum;
      }
    }
    for (int row = 0; row < N; ++row) {
      for (int j = 0; j < N; ++j) {
        double sum = s[row][j];
        for (int m = 0; m < j; ++m) sum -= lower[j][m] * t[row][m];
        t[row][j] = sum;
      }
    }
    for (int i = 0; i < N; ++i)
      for (int j = 0; j < N; ++j) s[i][j] = t[i][j] * std::sqrt(inverse[i]) * std::sqrt(inverse[j]);
    // The trace of the 16th power is the sum of the eigenvalues' 16th powers: within 7 % of the largest.
    for (int squaring = 0; squaring < 4; ++squaring) {
      for (int i = 0; i < N; ++i) {
        for (int j = 0; j < N; ++j) {
          t[i][j] = 0;
          for (int m = 0; m < N; ++m) t[i][j] += s[i][m] * s[m][j];
        }
      }
      std::copy(&t[0][0], &t[0][0] + N * N, &s[0][0]);
    }
    double sum = 0;
    for (int i = 0; i < N; ++i) sum += s[i][i];
    for (int root = 0; root < 4; ++root) sum = std::sqrt(sum);
    return static_cast<Real>(std::min(sum, 1.0));
  };
  return {largest(part[0]), largest(part[1])};
}

/// The share of its impulses that a joint applies at a time. Sequential impulses that are started from the
/// last ones, and pull errors back, grow without bound where many joints share a light body: each undoes what
/// all the others did. The other joints of a body undo (count - 1) times the body's load; beyond kLoad of
/// that, impulses and the pull are reduced in proportion. The linear model of a star of 3 to 40 bodies,
/// hinged or welded to a hub from a thousandth to ten times their mass, with arms of 0.5 to 10 times its
/// radius, is stable up to 2; at 2.5 its spectral radius reaches 1.03. Chains (1) and nets of equal bodies
/// (1.5) are below it.
template <class Real>
Real joint_share(JointLoad<Real> load, int count_a, int count_b) {
  constexpr Real kLoad = Real(1.6);
  const Real most =
      std::max(static_cast<Real>(count_a - 1) * load.a, static_cast<Real>(count_b - 1) * load.b);
  return most > kLoad ? kLoad / most : 1;
}

}  // namespace plumb
