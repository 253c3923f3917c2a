#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <vector>

/// Answers for the tests of Precise, in long double and in formulations that the engine does not use.
namespace plumb::truth {

using Real = long double;

/// Classical Runge-Kutta with a fixed step: y' = f(t, y).
using Rate = std::function<void(Real, const std::vector<Real>&, std::vector<Real>&)>;

inline std::vector<Real> integrate(const Rate& f, std::vector<Real> y, Real from, Real to, int steps) {
  const std::size_t n = y.size();
  std::vector<Real> k1(n), k2(n), k3(n), k4(n), at(n);
  const Real h = (to - from) / steps;
  const auto shifted = [&](const std::vector<Real>& k, Real s) {
    for (std::size_t i = 0; i < n; ++i) at[i] = y[i] + s * k[i];
    return at;
  };
  for (int step = 0; step < steps; ++step) {
    const Real t = from + h * step;
    f(t, y, k1);
    f(t + h / 2, shifted(k1, h / 2), k2);
    f(t + h / 2, shifted(k2, h / 2), k3);
    f(t + h, shifted(k3, h), k4);
    for (std::size_t i = 0; i < n; ++i) y[i] += h / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]);
  }
  return y;
}

/// Two runs of `integrate` combined so that the error goes with the fifth power of the step (Richardson).
inline std::vector<Real> integrate_twice(const Rate& f, const std::vector<Real>& y, Real from, Real to,
                                         int steps) {
  const std::vector<Real> coarse = integrate(f, y, from, to, steps);
  std::vector<Real> fine = integrate(f, y, from, to, 2 * steps);
  for (std::size_t i = 0; i < fine.size(); ++i) fine[i] += (fine[i] - coarse[i]) / 15;
  return fine;
}

/// N uniform rods of length 1 and mass 1 in a row, the first one's end held at the origin: absolute angles
/// as the only coordinates (Lagrange). M_ij = c_ij cos(q_i - q_j),
/// sum_j M_ij q_j'' = -sum_j c_ij sin(q_i - q_j) q_j'^2 - g (N - i - 1/2) cos q_i,   i from 0,
/// c_ij = N - max(i, j) - 1/2 for i != j and c_ii = N - i - 2/3: half and third lengths of the rods' own.
inline Rate chain_of_rods(int n, Real g) {
  return [n, g, m = std::vector<std::vector<Real>>(n, std::vector<Real>(n)), b = std::vector<Real>(n)](
             Real, const std::vector<Real>& y, std::vector<Real>& out) mutable {
    std::vector<Real> c(n), s(n);
    for (int i = 0; i < n; ++i) c[i] = std::cos(y[i]), s[i] = std::sin(y[i]);
    for (int i = 0; i < n; ++i) {
      b[i] = -g * (n - i - 0.5L) * c[i];
      for (int j = 0; j < n; ++j) {
        const Real coefficient = i == j ? n - i - 2.0L / 3 : n - std::max(i, j) - 0.5L;
        m[i][j] = coefficient * (c[i] * c[j] + s[i] * s[j]);
        b[i] -= coefficient * (s[i] * c[j] - c[i] * s[j]) * y[n + j] * y[n + j];
      }
    }
    // Cholesky's L D L^T.
    for (int j = 0; j < n; ++j) {
      for (int i = j + 1; i < n; ++i) {
        const Real factor = m[i][j] / m[j][j];
        for (int k = j + 1; k <= i; ++k) m[i][k] -= factor * m[k][j];
        b[i] -= factor * b[j];
      }
    }
    for (int i = n; i-- > 0;) {
      for (int k = i + 1; k < n; ++k) b[i] -= m[k][i] * out[n + k];
      out[n + i] = b[i] / m[i][i];
      out[i] = y[n + i];
    }
  };
}

/// Integral of f over [0, t] by Simpson's rule.
inline Real integral(const std::function<Real(Real)>& f, Real t, int intervals) {
  const Real h = t / intervals;
  Real sum = f(0) + f(t);
  for (int i = 1; i < intervals; ++i) sum += (i % 2 ? 4 : 2) * f(h * i);
  return sum * h / 3;
}

}  // namespace plumb::truth
