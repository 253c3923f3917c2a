#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "engine/joints/row.h"

namespace plumb {

/// Where a hinge, two rows, stands in an elimination: the one hinge that comes after it in L.
struct HingePlace {
  int hinge = 0;                ///< the first of its rows, halved
  int next = -1;                ///< its place in the order; none: -1
  int side = 0, next_side = 0;  ///< of the body that they share: 0 for a, 1 for b
};

/// The linear system of all joints at once, A = J M^-1 J^T, factorised as sparse L D L^T. The elimination
/// order is found once, from which rows share a moving body; no fill for chains and trees, so both
/// factorisation and solution are linear in their length. No allocation after construction. One thread at a
/// time.
template <class Real>
class JointSystem {
 public:
  /// `rows` gives the bodies of each row (its numbers are ignored); `inverse_mass`, `inverse_inertia` are a
  /// body's, both zero for a body that joints cannot move.
  JointSystem(std::span<const Row<Real>> rows, std::span<const Real> inverse_mass,
              std::span<const Real> inverse_inertia);

  /// Factorises for the Jacobian in `rows`, which has the pattern of construction. Rows that depend on others
  /// get a zero multiplier; returns how many.
  int factor(std::span<const Row<Real>> rows);

  /// Rows that the others leave less than `share` of, count as dependent from now on; 0: what is rounding.
  void set_least_share(Real share);
  /// The rows that the last factorisation found dependent are dependent in all later ones, whatever rounding
  /// makes of their pivots; `release_dependent` ends that.
  void keep_dependent();
  void release_dependent() { kept_.clear(), kept_count_ = 0; }
  int kept() const { return kept_count_; }  ///< how many these are

  /// Solves A x = right_side in place, with the last factorisation.
  void solve(std::span<Real> right_side) const;

  /// One step of iterative refinement of `x`, a solution for `right_side` from `solve`, with the rows of the
  /// last factorisation. The residual is taken from J M^-1 (J^T x) term by term, where a light body's inverse
  /// mass does not swallow a heavy one's as it does in A itself: wide mass ratios get their digits back.
  void refine(std::span<const Row<Real>> rows, std::span<const Real> right_side, std::span<Real> x) const;

  /// Of the last factorisation: the least share of a row that the others leave to it, dependent rows apart.
  /// It goes to zero where the mechanism becomes singular.
  Real weakest() const { return weakest_; }
  /// Its row; `row_count` where no row is weaker than alone.
  std::size_t weakest_row() const {
    return weakest_place_ < order_.size() ? static_cast<std::size_t>(order_[weakest_place_]) : order_.size();
  }
  /// Of the last factorisation: whether a row depends on others.
  std::vector<char> dependent() const;

  /// Hinges in the order of elimination, where there is nothing else and each has one neighbour after it at
  /// most; empty else.
  std::vector<HingePlace> hinges() const;

  std::size_t row_count() const { return order_.size(); }
  /// Entries of L below its diagonal: what factorisation and solution cost.
  std::size_t nonzeros() const { return row_of_.size(); }

 private:
  /// A body's part in an entry of A: row `place` and the row being factorised share it.
  struct Term {
    int place = 0;            // of the earlier row in the elimination order, or of the row itself
    int left = 0, right = 0;  // where the two rows' three numbers for that body begin
  };

  /// Two rows of one hinge, eliminated together, and the hinge that comes after them in L: where hinges lie
  /// in lines, each has one at most.
  struct Hinge {
    int row = 0, place = 0;
    int next = -1;                // of the hinges
    int side = 0, next_side = 0;  // of the body that they share: 0 for a, 1 for b
  };
  /// Of A, less what earlier hinges took: a 2 x 2 block, and its diagonal as it was.
  struct HingeBlock {
    Real own[2]{}, rest[3]{};  // (1, 1), (2, 1), (2, 2)
  };

  void find_hinges(std::span<const Row<Real>> rows, const std::vector<int>& place);
  HingeBlock hinge_block(const Row<Real>& first, const Row<Real>& second) const;
  int factor_hinges(std::span<const Row<Real>> rows);
  void solve_hinges() const;
  bool take_pivot(Real pivot, Real own, std::size_t place);

  void find_pattern(const std::vector<std::vector<int>>& below);
  void take_jacobian(std::span<const Row<Real>> rows);
  void find_terms(std::span<const Row<Real>> rows, const std::vector<int>& place);

  std::vector<Real> inverse_mass_, inverse_inertia_;  // by body
  std::vector<int> order_;                            // the caller's row at each place of the order

  // L by columns, the unit diagonal left out: column j holds entries [column_start_[j], column_start_[j +
  // 1]).
  std::vector<std::size_t> column_start_;
  std::vector<int> row_of_;
  std::vector<Real> lower_;
  // L's pattern by rows: row i has entries in the columns column_of_[row_start_[i] ... row_start_[i + 1]).
  std::vector<std::size_t> row_start_;
  std::vector<int> column_of_;

  // A's lower triangle by rows, as sums over shared bodies.
  std::vector<std::size_t> term_start_;
  std::vector<Term> terms_;
  // J and J M^-1: x, y and angle of body a, then of body b, row after row.
  std::vector<Real> jacobian_, weighted_;

  std::vector<Real> inverse_diagonal_;  // of D; zero for a dependent row
  Real weakest_ = 1, least_share_ = 0;
  std::size_t weakest_place_ = 0;
  int kept_count_ = 0;
  std::vector<char> kept_;     // by place, dependent rows that stay so; empty: none
  std::vector<Hinge> hinges_;  // in the elimination order; empty unless all rows are of hinges in lines
  std::vector<HingeBlock> hinge_blocks_;
  std::vector<std::size_t> filled_;  // while factorising: the end of what is known of a column
  mutable std::vector<Real> work_;
  mutable std::vector<Real> residual_;         // by row
  mutable std::vector<Twist<Real>> response_;  // by body: M^-1 J^T x
};

}  // namespace plumb
