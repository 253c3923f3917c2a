#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace plumb {

/// A square matrix whose entries lie near its diagonal, factorised as P L U with partial pivoting (G. H.
/// Golub, C. F. Van Loan, Matrix Computations, 4.3). Costs n w^2 with w the band width.
class BandedLu {
 public:
  /// `below` and `above`: largest distance of entries from the diagonal. Sets all entries to zero.
  void reset(std::size_t size, std::size_t below, std::size_t above);

  std::size_t size() const { return size_; }
  void clear();
  double& at(std::size_t row, std::size_t column) {
    return entries_[row * width_ + column + lower_band_ - row];
  }

  /// Returns false if the matrix is singular or not finite.
  bool factor();

  /// Solves for `x` in place with the last factorisation.
  void solve(std::span<double> x) const;

 private:
  std::size_t last_in(std::size_t row) const {
    return row + upper_band_ < size_ ? row + upper_band_ : size_ - 1;
  }

  std::size_t size_ = 0, lower_band_ = 0, upper_band_ = 0,
              width_ = 1;        // upper_band_: upper band width of U, which pivoting enlarges
  std::vector<double> entries_;  // row by row, from `lower_band_` before the diagonal
  std::vector<double> lower_;    // multipliers, `lower_band_` of them per column
  std::vector<std::size_t> pivot_;
};

}  // namespace plumb
