#pragma once

#include <vector>

#include "scenarios/truth/parts.h"
#include "scenarios/truth/trajectory.h"

namespace plumb::scenarios::truth {

/// Point masses on massless rods of 1 m, one below the other from the origin. In absolute angles t_i from the
/// vertical, with u_k the mass of bob k and of all below it, Lagrange's equations are
///
///   sum_j u_max(i,j) cos(t_i - t_j) t_j'' = - sum_j u_max(i,j) sin(t_i - t_j) t_j'^2 - g u_i sin t_i,
///
/// solved by Cholesky's method.
struct BobChain {
  std::vector<double> masses;  ///< kg, from the top
  std::vector<double> angles;  ///< rad, of the rods at the start

  /// Returns `scene` with bobs and rods, at rest.
  Scene scene(Scene scene) const;
  Truth truth(const Scene& scene) const;

  void rates(const Trajectory::State& state, Trajectory::State& rate) const;
};

/// Returns the smallest zero of the Laguerre polynomial L_n. Small swings of n equal bobs have w^2 = g/L
/// times its zeros, and bob i from below then moves by L_i in proportion. Source: Bernoulli, 1733; Newton's
/// method.
double smallest_laguerre_zero(int n);

/// Returns L_n(x), by recurrence.
double laguerre(int n, double x);

}  // namespace plumb::scenarios::truth
