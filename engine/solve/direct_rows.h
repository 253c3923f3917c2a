#pragma once

#include <vector>

#include "engine/solve/body_motion.h"
#include "engine/solve/envelope_matrix.h"

namespace plumb {

/// One row of a constraint, as the direct solver sees it.
template <class Real>
struct DirectRow {
  int a = 0, b = 0;                   ///< bodies
  Vec2<Real> linear_a{}, linear_b{};  ///< J
  Real angular_a = 0, angular_b = 0;
  Real bias = 0;            ///< m/s: J v + bias = 0 is asked for
  Real* impulse = nullptr;  ///< what is kept of it from substep to substep
  bool one_sided = false;   ///< impulse >= 0
  bool active = true;       ///< takes part: a one-sided row that would have to pull does not
  int block = 0;            ///< the constraint that it belongs to
};

/// The rows of a few constraints that hang together, solved all at once: J M^-1 J^T x = -(J v + bias), by a
/// sparse factorisation that is made once a step and used in all its substeps. What sequential impulses need
/// many sweeps for (a heavy load on light things, a long way from the load to the ground) is right at once.
/// Rows that would have to pull are left out, and the factorisation is made anew without them.
template <class Real>
class DirectRows {
 public:
  std::vector<DirectRow<Real>> rows;  ///< filled by the caller, rows of one constraint side by side

  /// Orders the rows (Cuthill and McKee, 1969, reversed) and says what factorising them would cost, in
  /// multiplications.
  double order(const BodyMotion<Real>* motion);
  /// Factorises for the bodies' masses and the rows' Jacobians as they are.
  void factorise(const BodyMotion<Real>* motion);
  /// Applies the impulses; false, and no more than pulls are taken out, when no set of pressing rows was
  /// found in a few tries.
  bool solve(BodyMotion<Real>* motion);

 private:
  std::vector<int> sequence_;  // place -> row
  std::vector<int> place_;     // row -> place
  std::vector<int> first_;
  std::vector<std::vector<int>> neighbours_;  // of blocks
  std::vector<std::pair<int, int>> ends_;     // body, block
  std::vector<int> blocks_, block_first_, queue_, degree_;
  std::vector<double> x_;
  EnvelopeMatrix matrix_;
};

}  // namespace plumb
