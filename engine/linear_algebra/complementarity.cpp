#include "engine/linear_algebra/complementarity.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <iterator>
#include <optional>

#include "engine/linear_algebra/dense_system.h"
#include "engine/linear_algebra/matrix_components.h"

namespace plumb {
namespace {

/// w - M z - d z0 = q, d the covering vector, as a tableau of n rows. Columns: w (n), z (n), z0, q.
class Tableau {
 public:
  Tableau(std::span<const double> matrix, std::span<const double> q, std::span<const double> covering,
          double min_pivot)
      : n_(q.size()), width_(2 * n_ + 2), entries_(n_ * width_, 0.0), basis_(n_) {
    assert(matrix.size() == n_ * n_ && covering.size() == n_);
    for (std::size_t i = 0; i < n_; ++i) {
      at(i, i) = 1;
      for (std::size_t j = 0; j < n_; ++j) at(i, n_ + j) = -matrix[i * n_ + j];
      at(i, cover()) = -covering[i];
      at(i, width_ - 1) = q[i];
      basis_[i] = i;
    }
    double largest = 1;
    for (const double x : matrix) largest = std::max(largest, std::abs(x));
    min_pivot_ = min_pivot * largest;
  }

  std::size_t cover() const { return 2 * n_; }  // column of z0
  std::size_t basis(std::size_t row) const { return basis_[row]; }
  double value(std::size_t row) const { return entries_[row * width_ + width_ - 1]; }

  /// Returns the column that may enter after `column` has left.
  std::size_t complement(std::size_t column) const { return column < n_ ? column + n_ : column - n_; }

  /// Returns the lexicographically least row [q, w columns] in the present tableau, relative to the covering
  /// vector.
  std::size_t first_leaving() const {
    std::size_t best = 0;
    for (std::size_t i = 1; i < n_; ++i) {
      if (precedes(i, -at(i, cover()), best, -at(best, cover()))) best = i;
    }
    return best;
  }

  /// Returns the row that leaves when `column` enters: the one with the lexicographically least ratio;
  /// nullopt on a ray. z0 leaves as soon as possible.
  std::optional<std::size_t> leaving(std::size_t column) const {
    std::optional<std::size_t> best;
    for (std::size_t i = 0; i < n_; ++i) {
      if (!(at(i, column) > min_pivot_)) continue;
      if (!best || precedes(i, at(i, column), *best, at(*best, column))) best = i;
    }
    if (!best) return best;
    for (std::size_t i = 0; i < n_; ++i) {  // ties: z0 first
      if (basis_[i] != cover() || !(at(i, column) > min_pivot_)) continue;
      const double ratio = value(i) / at(i, column), least = value(*best) / at(*best, column);
      if (ratio <= least + 1e-14 * std::abs(least)) return i;
    }
    return best;
  }

  void pivot(std::size_t row, std::size_t column) {
    assert(row < n_ && column < width_ - 1);
    assert(at(row, column) != 0);
    const double scale = 1 / at(row, column);
    entries_in_row_.clear();  // sparse: most contacts do not couple, so few entries are nonzero
    for (std::size_t j = 0; j < width_; ++j) {
      at(row, j) *= scale;
      if (at(row, j) != 0) entries_in_row_.push_back(j);
    }
    at(row, column) = 1;
    for (std::size_t i = 0; i < n_; ++i) {
      const double factor = at(i, column);
      if (i == row || factor == 0) continue;
      for (const std::size_t j : entries_in_row_) at(i, j) -= factor * at(row, j);
      at(i, column) = 0;
    }
    basis_[row] = column;
  }

 private:
  double& at(std::size_t i, std::size_t j) { return entries_[i * width_ + j]; }
  double at(std::size_t i, std::size_t j) const { return entries_[i * width_ + j]; }

  bool precedes(std::size_t i, double by_i, std::size_t j, double by_j) const {
    const double a = value(i) / by_i, b = value(j) / by_j;
    if (a != b) return a < b;
    for (std::size_t k = 0; k < n_; ++k) {
      const double x = at(i, k) / by_i, y = at(j, k) / by_j;
      if (x != y) return x < y;
    }
    return false;
  }

  std::size_t n_, width_;
  std::vector<double> entries_;
  std::vector<std::size_t> basis_, entries_in_row_;
  double min_pivot_ = 0;
};

/// Recomputes the basic components from the original problem, to remove the rounding errors of pivoting.
void polish(std::span<const double> matrix, std::span<const double> q, ComplementaritySolution& solution) {
  const std::size_t n = q.size();
  std::vector<std::size_t> in;
  for (std::size_t i = 0; i < n; ++i) {
    if (solution.basic[i]) in.push_back(i);
  }
  std::vector<double> part(in.size() * in.size()), z(in.size());
  for (std::size_t i = 0; i < in.size(); ++i) {
    z[i] = -q[in[i]];
    for (std::size_t j = 0; j < in.size(); ++j) part[i * in.size() + j] = matrix[in[i] * n + in[j]];
  }
  DenseSystem system;
  const bool regular = system.factor(in.size(), part) == in.size();
  system.solve_refined(z);
  // Dependent columns have many solutions: reject this one if it has a negative component.
  if (!regular && std::any_of(z.begin(), z.end(), [](double x) { return x < 0; })) return;
  for (std::size_t i = 0; i < in.size(); ++i) solution.z[in[i]] = std::max(z[i], 0.0);
}

ComplementaritySolution run_lemke(std::span<const double> matrix, std::span<const double> q,
                                  std::span<const double> covering, double min_pivot) {
  using Status = ComplementaritySolution::Status;
  const std::size_t n = q.size();
  ComplementaritySolution solution;
  solution.z.assign(n, 0.0);
  solution.basic.assign(n, 0);
  Tableau tableau(matrix, q, covering, min_pivot);
  std::size_t row = tableau.first_leaving(), entering = tableau.cover();
  const int max_pivots = 50 * static_cast<int>(n) + 50;
  for (;;) {
    const std::size_t left = tableau.basis(row);
    tableau.pivot(row, entering);
    ++solution.pivots;
    if (left == tableau.cover()) break;
    if (solution.pivots > max_pivots) {
      solution.status = Status::Limit;
      return solution;
    }
    entering = tableau.complement(left);
    const auto next = tableau.leaving(entering);
    if (!next) {
      solution.status = Status::Ray;
      return solution;
    }
    row = *next;
  }
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t column = tableau.basis(i);
    if (column < n || column == tableau.cover()) continue;
    solution.basic[column - n] = 1;
    solution.z[column - n] = std::max(tableau.value(i), 0.0);
  }
  return solution;
}

/// Returns true if w >= 0 up to rounding, and w = 0 for basic z.
bool is_solution(std::span<const double> matrix, std::span<const double> q,
                 const ComplementaritySolution& solution) {
  constexpr double kRounding = 1e-9;
  const std::size_t n = q.size();
  for (std::size_t i = 0; i < n; ++i) {
    double w = q[i], size = 1;
    for (std::size_t j = 0; j < n; ++j) {
      w += matrix[i * n + j] * solution.z[j];
      size = std::max(size, std::abs(matrix[i * n + j] * solution.z[j]));
    }
    if (w < -kRounding * size || (solution.basic[i] && w > kRounding * size)) return false;
  }
  return true;
}

ComplementaritySolution solve_component(std::span<const double> matrix, std::span<const double> q) {
  using Status = ComplementaritySolution::Status;
  const std::size_t n = q.size();
  ComplementaritySolution solution;
  solution.z.assign(n, 0.0);
  solution.basic.assign(n, 0);
  if (std::all_of(q.begin(), q.end(), [](double x) { return x >= 0; })) return solution;
  // After a failure by rounding or on a ray, tries another covering vector, which takes another path. A
  // slightly enlarged diagonal avoids pivots that consist of rounding error.
  constexpr double kMinPivot[] = {1e-11, 1e-13, 1e-9, 1e-12, 1e-12, 1e-12};
  constexpr double kDiagonalShift[] = {0, 0, 0, 0, 1e-10, 1e-8};
  std::vector<double> enlarged(matrix.begin(), matrix.end());
  std::vector<double> covering(n, 1.0);
  int pivots = 0;
  for (std::size_t trial = 0; trial < std::size(kMinPivot); ++trial) {
    for (std::size_t i = 0; i < n; ++i) enlarged[i * n + i] = matrix[i * n + i] + kDiagonalShift[trial];
    solution = run_lemke(enlarged, q, covering, kMinPivot[trial]);
    if (solution.status == Status::Solved) polish(matrix, q, solution);
    pivots += solution.pivots;
    if (solution.status == Status::Solved && !is_solution(matrix, q, solution))
      solution.status = Status::Limit;
    if (solution.status == Status::Solved) break;
    for (std::size_t i = 0; i < n; ++i) covering[i] = 1 + static_cast<double>((i * (trial + 3)) % 7) / 7;
  }
  solution.pivots = pivots;
  return solution;
}

}  // namespace

ComplementaritySolution solve_complementarity(std::span<const double> matrix, std::span<const double> q) {
  MatrixComponents components;
  components.compute(q.size(), matrix);
  if (components.count() == 1) return solve_component(matrix, q);
  ComplementaritySolution solution;
  solution.z.assign(q.size(), 0.0);
  solution.basic.assign(q.size(), 0);
  std::vector<double> own_matrix, own_q;
  for (std::size_t p = 0; p < components.count(); ++p) {
    const std::span<const std::size_t> rows = components.component(p);
    components.extract(p, matrix, own_matrix);
    own_q.clear();
    for (const std::size_t i : rows) own_q.push_back(q[i]);
    const ComplementaritySolution own = solve_component(own_matrix, own_q);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      solution.z[rows[i]] = own.z[i];
      solution.basic[rows[i]] = own.basic[i];
    }
    solution.pivots += own.pivots;
    if (own.status == ComplementaritySolution::Status::Solved) continue;
    solution.status = own.status;
    return solution;
  }
  return solution;
}

}  // namespace plumb
