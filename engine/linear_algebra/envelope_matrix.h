#pragma once

#include <memory_resource>
#include <span>
#include <vector>

namespace plumb {

/// A symmetric positive definite matrix, stored by row from the first entry to the diagonal. Its
/// factorisation L D L^T fills in only this envelope (George and Liu, Computer Solution of Large Sparse
/// Positive Definite Systems, 1981, ch. 4). For chains and towers the cost is linear.
class EnvelopeMatrix {
 public:
  explicit EnvelopeMatrix(std::pmr::memory_resource* memory = std::pmr::get_default_resource())
      : first_columns_(memory),
        row_starts_(memory),
        values_(memory),
        inverse_pivots_(memory),
        steps_(memory) {}

  /// Sets up rows 0 .. first.size() - 1, row i from column first[i] <= i, with zeros. Allocates only when it
  /// grows.
  void reset(std::span<const int> first);

  /// Does the same without setting entries: the caller sets all of them.
  void shape(std::span<const int> first);

  int size() const { return static_cast<int>(first_columns_.size()); }
  int first(int row) const { return first_columns_[row]; }
  /// Returns a row from its first entry to the diagonal.
  double* row(int row) { return &values_[row_starts_[row]]; }
  double& at(int row, int column) { return values_[row_starts_[row] + column - first_columns_[row]]; }
  double at(int row, int column) const { return values_[row_starts_[row] + column - first_columns_[row]]; }

  /// Factorises in place. Dependent rows are left out: their unknown is 0. If only the rows from `from` on
  /// were set anew, and those before it are still factorised, factorises only the new ones. Returns their
  /// smallest pivot as a fraction of its diagonal, which is near 0 if rows depend on each other.
  double factorise(int from = 0);

  /// Changes the factors to those of the matrix without a row and its column; the row's unknown becomes 0.
  /// Takes two multiplications per entry behind the row. Only if no row depends on others, and the row was
  /// not removed before.
  void remove(int row);
  bool is_removed(int row) const { return inverse_pivots_[row] == 0; }
  bool has_dependent_rows() const { return has_dependent_rows_; }

  /// Solves: x <- A^-1 x.
  void solve(double* x) const;

  /// Returns the number of multiplications of `factorise(from)` for such an envelope.
  static double cost(std::span<const int> first, int from = 0);
  double cost(int from) const { return cost(first_columns_, from); }

  /// Returns the number of entries in the envelope, or in its rows from `from` on.
  std::size_t entries() const { return values_.size(); }
  std::size_t entries(int from) const { return from < size() ? values_.size() - row_starts_[from] : 0; }

 private:
  std::pmr::vector<int> first_columns_, row_starts_;
  std::pmr::vector<double> values_, inverse_pivots_;
  struct UpdateStep {
    double entry = 0, gain = 0;  // of a column: entry of the vector that is added, multiple that changes L
  };
  std::pmr::vector<UpdateStep> steps_;  // used by `remove`
  bool has_dependent_rows_ = false;
};

}  // namespace plumb
