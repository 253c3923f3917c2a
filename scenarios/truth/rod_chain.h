#pragma once

#include <span>
#include <vector>

#include "scenarios/scenario.h"
#include "scenarios/truth/motion.h"
#include "scenarios/truth/trajectory.h"

namespace plumb::scenarios::truth {

/// A chain of equal uniform rods (their mass cancels) that hangs from a fixed pivot at the origin. It uses
/// minimal coordinates, one absolute angle per rod, from +x, so that joints cannot open. Lagrange's equations
/// with n_k = N - k - 1/2 (rods beyond rod k and half of itself, k from 0), in units of m L^2:
///
///   sum_j M_ij a_j = - sum_j n_max(i,j) sin(t_i - t_j) w_j^2 - (g/L) n_i cos t_i,
///   M_ij = n_max(i,j) cos(t_i - t_j) for i != j,  M_ii = n_i - 1/6   (I = m L^2/12).
///
/// Source: e.g. Tomaszewski, Pieranski, Geminard, The motion of a freely falling chain tip, Am. J. Phys. 74
/// (2006).
class RodChain {
 public:
  using State = Trajectory::State;  ///< N angles, then N angular velocities

  RodChain(int count, Real length, Real gravity);

  std::size_t count() const { return count_; }

  /// Computes d(state)/dt in O(N): with u = (cos t, sin t), M_ij = n_i u_i . u_j below the diagonal has rank
  /// two, and so has its Cholesky factor.
  void rates(const State& state, State& rate) const;

  /// Returns the positions and velocities of the rods' centres.
  std::vector<Motion> motions(const State& state) const;

 private:
  std::size_t count_;
  Real length_, gravity_;
};

/// Returns the truth of `count` rods of 1 m that start at rest along +x, in gravity of 9.81 m/s^2. It is kept
/// while the program runs, because all engines are compared with it.
Truth rod_chain_truth(int count);

/// Returns the digits promised at t = 1 s with the tolerance 1e-9: 1e-9 for one rod, 1e-8 for 2 to 5, 1e-6
/// for 20 and 1e-5 for 100. In between (and beyond) it follows the straight line through these in log-log.
double rod_chain_digits(int count);

}  // namespace plumb::scenarios::truth
