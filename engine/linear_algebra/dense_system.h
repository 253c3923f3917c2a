#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "engine/linear_algebra/matrix_components.h"

namespace plumb {

/// A square linear system A x = b, factorised by Gaussian elimination with complete pivoting. Dependent
/// equations are left out, and as many unknowns are zero, so a consistent system is still solved. Independent
/// groups of unknowns are eliminated separately, and zero entries cost nothing. Sparse systems therefore cost
/// far less than n^3.
class DenseSystem {
 public:
  /// Factorises the matrix of `size` rows, row after row. Returns the rank: pivots below `dependent` times
  /// the largest entry count as rounding.
  std::size_t factor(std::size_t size, std::span<const double> matrix, double dependent = 1e-12);

  /// Solves A x = b in place.
  void solve(std::span<double> b) const;

  /// Solves as `solve`, plus one step of iterative refinement with the original matrix.
  void solve_refined(std::span<double> b);

 private:
  struct Part {
    std::size_t size = 0, rank = 0;
    std::vector<double> lu;
    std::vector<std::size_t> row, column;  // original index at each place
    // During elimination, of the remaining matrix: the largest magnitude of each row, the unknowns of its
    // nonzero entries, and the final place of each unknown's column.
    std::vector<double> largest;
    std::vector<std::vector<std::size_t>> entries;
    std::vector<std::size_t> place;
    void begin();
    void factor(double least);
    void move_pivot(std::size_t from_row);
    void eliminate();
    void solve(std::span<double> b, std::span<double> work) const;
  };

  std::size_t size_ = 0, rank_ = 0;
  std::vector<double> original_;
  MatrixComponents components_;
  std::vector<Part> parts_;  // as many as there are; unused ones keep their memory
  mutable std::vector<double> work_;
  std::vector<double> residual_;
};

}  // namespace plumb
