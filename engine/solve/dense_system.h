#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace plumb {

/// A square linear system A x = b, factorised by Gaussian elimination with complete pivoting. Equations that
/// depend on others are left out, and as many unknowns are zero: a consistent system is solved all the same.
class DenseSystem {
 public:
  /// Factorises the matrix of `size` rows, row after row. Returns the rank: pivots below `dependent` times
  /// the largest entry count as rounding.
  std::size_t factor(std::size_t size, std::span<const double> matrix, double dependent = 1e-12);

  /// Solves A x = b in place.
  void solve(std::span<double> b) const;

  /// `solve`, and one step of iterative refinement with the matrix that was factorised.
  void solve_refined(std::span<double> b);

  std::size_t rank() const { return rank_; }

 private:
  void eliminate(std::size_t k);

  std::size_t size_ = 0, rank_ = 0;
  std::vector<double> original_, lu_;
  std::vector<std::size_t> row_, column_;  // the caller's row and column at each place
  mutable std::vector<double> work_;
  std::vector<double> residual_;
};

}  // namespace plumb
