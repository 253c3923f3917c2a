#pragma once

#include <span>
#include <vector>

#include "engine/joints/row.h"

namespace plumb {

/// The linear system of all joints at once, A = J M^-1 J^T, factorised as sparse L D L^T. The elimination order
/// is found once, from which rows share a moving body; no fill for chains and trees, so both factorisation
/// and solution are linear in their length. No allocation after construction.
template <class Real>
class JointSystem {
 public:
  /// `rows` gives the bodies of each row (its numbers are ignored); `inverse_mass`, `inverse_inertia` are a body's.
  JointSystem(std::span<const Row<Real>> rows, std::span<const Real> inverse_mass,
              std::span<const Real> inverse_inertia);

  /// Factorises for the Jacobian in `rows`, which has the pattern of construction. Rows that depend on others
  /// get a zero multiplier; returns how many.
  int factor(std::span<const Row<Real>> rows);

  /// Solves A x = right_side in place, with the last factorisation.
  void solve(std::span<Real> right_side) const;
};

}  // namespace plumb
