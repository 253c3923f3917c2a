#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "engine/joints/row.h"

namespace plumb {

/// Place of a hinge (two rows) in an elimination, and the only later hinge that L couples to it.
struct HingePlace {
  int hinge = 0;                ///< its first row, halved
  int next = -1;                ///< place of the next one in the order; none: -1
  int side = 0, next_side = 0;  ///< of the shared body: 0 for a, 1 for b
};

/// The linear system of all joints, A = J M^-1 J^T, factorised as sparse L D L^T. The elimination order is
/// computed once, from the bodies that rows share. Chains and trees have no fill, so factorisation and
/// solution are linear in their length. No allocation after construction. Not thread-safe.
template <class Real>
class JointSystem {
 public:
  /// `rows` gives the bodies of each row (its numbers are ignored). `inverse_mass` and `inverse_inertia` are
  /// by body, both zero for a body that joints cannot move.
  JointSystem(std::span<const Row<Real>> rows, std::span<const Real> inverse_mass,
              std::span<const Real> inverse_inertia);

  /// Factorises for the Jacobian in `rows`, which has the pattern of construction. Dependent rows get a zero
  /// multiplier; returns their number.
  int factor(std::span<const Row<Real>> rows);

  /// Sets the independent fraction of a row below which it counts as dependent from now on. 0: only rounding
  /// counts.
  void set_pivot_threshold(Real ratio);
  /// Keeps the dependent rows of the last factorisation dependent in all later ones, for any rounding of
  /// their pivots, until `release_dependent`.
  void freeze_dependent();
  void release_dependent() { frozen_.clear(), frozen_count_ = 0; }
  int frozen_count() const { return frozen_count_; }  ///< number of these rows

  /// Solves A x = right_side in place, with the last factorisation.
  void solve(std::span<Real> right_side) const;

  /// Makes one step of iterative refinement of `x`, a solution for `right_side` from `solve`, with the rows
  /// of the last factorisation. The residual is evaluated from J M^-1 (J^T x) term by term. In A itself a
  /// light body's inverse mass swallows a heavy one's; here wide mass ratios regain their digits.
  void refine(std::span<const Row<Real>> rows, std::span<const Real> right_side, std::span<Real> x) const;

  /// Returns the least independent fraction of a row in the last factorisation, except dependent rows. It
  /// goes to zero as the mechanism becomes singular.
  Real min_pivot_ratio() const { return min_pivot_ratio_; }
  /// Returns the row of `min_pivot_ratio`; `row_count` if all rows are as independent as they would be alone.
  std::size_t min_pivot_row() const {
    return min_pivot_place_ < order_.size() ? static_cast<std::size_t>(order_[min_pivot_place_])
                                            : order_.size();
  }
  /// Returns, by row, 1 if it was dependent in the last factorisation, else 0.
  std::vector<char> dependent() const;

  /// Returns the hinges in elimination order, if there are only hinges and each has at most one later
  /// neighbour; else empty.
  std::vector<HingePlace> hinges() const;

  std::size_t row_count() const { return order_.size(); }
  /// Returns the number of entries of L below its diagonal: the cost of factorisation and solution.
  std::size_t nonzeros() const { return row_of_.size(); }

 private:
  /// One term of an entry of A: the contribution of a body that row `place` shares with the row being
  /// factorised.
  struct Term {
    int place = 0;            // of the earlier row in the elimination order, or of the same row
    int left = 0, right = 0;  // first index of the three numbers that each of the two rows has for that body
  };

  /// Two rows of one hinge, eliminated together, and the next hinge in L: in a chain there is at most one.
  struct Hinge {
    int row = 0, place = 0;
    int next = -1;                // index among the hinges
    int side = 0, next_side = 0;  // of the shared body: 0 for a, 1 for b
  };
  /// A 2 x 2 block of A after elimination of the earlier hinges, and its original diagonal.
  struct HingeBlock {
    Real diagonal[2]{}, reduced[3]{};  // (1, 1), (2, 1), (2, 2)
  };

  void find_hinges(std::span<const Row<Real>> rows, const std::vector<int>& place);
  HingeBlock hinge_block(const Row<Real>& first, const Row<Real>& second) const;
  int factor_hinges(std::span<const Row<Real>> rows);
  void solve_hinges() const;
  bool set_pivot(Real pivot, Real diagonal, std::size_t place);

  void find_pattern(const std::vector<std::vector<int>>& below);
  void set_jacobian(std::span<const Row<Real>> rows);
  void find_terms(std::span<const Row<Real>> rows, const std::vector<int>& place);

  std::vector<Real> inverse_mass_, inverse_inertia_;  // by body
  std::vector<int> order_;                            // the caller's row at each place of the order

  // L by columns, without the unit diagonal: column j holds entries [column_start_[j], column_start_[j + 1]).
  std::vector<std::size_t> column_start_;
  std::vector<int> row_of_;
  std::vector<Real> lower_;
  // L's pattern by rows: row i has entries in the columns column_of_[row_start_[i] ... row_start_[i + 1]).
  std::vector<std::size_t> row_start_;
  std::vector<int> column_of_;

  // A's lower triangle by rows, as sums over shared bodies.
  std::vector<std::size_t> term_start_;
  std::vector<Term> terms_;
  // J and J M^-1: x, y and angle of body a, then of body b, row by row.
  std::vector<Real> jacobian_, weighted_;

  std::vector<Real> inverse_diagonal_;  // of D; zero for a dependent row
  Real min_pivot_ratio_ = 1, pivot_threshold_ = 0;
  std::size_t min_pivot_place_ = 0;
  int frozen_count_ = 0;
  std::vector<char> frozen_;   // by place: dependent rows that stay so; empty: none
  std::vector<Hinge> hinges_;  // in elimination order; empty unless all rows are of hinges in chains
  std::vector<HingeBlock> hinge_blocks_;
  std::vector<std::size_t> filled_;  // while factorising: end of the known part of a column
  mutable std::vector<Real> work_;
  mutable std::vector<Real> residual_;         // by row
  mutable std::vector<Twist<Real>> response_;  // by body: M^-1 J^T x
};

}  // namespace plumb
