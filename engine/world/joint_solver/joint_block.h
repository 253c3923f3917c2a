#pragma once

#include <algorithm>
#include <limits>

#include "engine/world/joint_solver/joint_rule.h"
#include "engine/world/joint_solver/joint_velocities.h"

namespace plumb {

/// N rigid rows solved together: K = J M^-1 J^T = L D L^T. A row that depends on previous rows is left out.
template <class Real, int N>
struct JointBlock {
  JointRow<Real> row[N]{};
  Real lower[N][N]{};  ///< L below its diagonal of ones
  Real inverse_pivot[N]{};
  Real impulse[N]{};

  /// Factorises for the present rows.
  [[gnu::always_inline]] void factorise(const JointVelocities<Real>& v) {
    constexpr Scalar<Real> kPivotTolerance = 32 * std::numeric_limits<Scalar<Real>>::epsilon();
    Real pivot[N];
    for (int i = 0; i < N; ++i) {
      const Real diagonal = v.inverse_mass(row[i], row[i]);
      Real rest = diagonal;
      for (int j = 0; j < i; ++j) {
        Real sum = v.inverse_mass(row[i], row[j]);
        for (int k = 0; k < j; ++k) sum -= lower[i][k] * pivot[k] * lower[j][k];
        lower[i][j] = sum * inverse_pivot[j];
        rest -= lower[i][j] * lower[i][j] * pivot[j];
      }
      const auto free = rest > kPivotTolerance * diagonal;
      pivot[i] = select(free, rest, Real(0));
      inverse_pivot[i] = select(free, Real(Real(1) / rest), Real(0));
    }
  }
  [[gnu::always_inline]] void warm_start(JointVelocities<Real>& v) const {
    for (int i = 0; i < N; ++i) v.apply(row[i], impulse[i]);
  }

  /// Solves once. The rows close with the speed of the slowest, so that they stay in proportion.
  [[gnu::always_inline]] void solve(JointVelocities<Real>& v, const Softness<Scalar<Real>>& soft,
                                    JointPass pass, Real factor) {
    using std::min;
    Real closing = 1;
    if (pass == kSolve) {
      for (int i = 0; i < N; ++i) {
        const Real bias = factor * soft.bias_rate * row[i].residual;
        closing = min(closing, closing_fraction(v, bias * bias, row[i]));
      }
    }
    solve_unlimited(v, soft, pass, factor, closing);
  }
  /// Does the same with the fraction `closing` of the bias, whatever its speed.
  [[gnu::always_inline]] void solve_unlimited(JointVelocities<Real>& v, const Softness<Scalar<Real>>& soft,
                                              JointPass pass, Real factor, Real closing) {
    const Softness<Scalar<Real>> s = pass == kSolve ? soft : Softness<Scalar<Real>>{};
    Real x[N];
    for (int i = 0; i < N; ++i) x[i] = v.along(row[i]) + closing * (factor * s.bias_rate * row[i].residual);
    for (int i = 1; i < N; ++i)
      for (int j = 0; j < i; ++j) x[i] -= lower[i][j] * x[j];
    for (int i = 0; i < N; ++i) x[i] *= inverse_pivot[i];
    for (int i = N - 2; i >= 0; --i)
      for (int j = i + 1; j < N; ++j) x[i] -= lower[j][i] * x[j];
    for (int i = 0; i < N; ++i) {
      const Real delta = -factor * s.mass_scale * x[i] - s.impulse_scale * impulse[i];
      impulse[i] += delta;
      v.apply(row[i], delta);
    }
  }
};

}  // namespace plumb
