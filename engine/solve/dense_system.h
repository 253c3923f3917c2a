#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "engine/solve/matrix_parts.h"

namespace plumb {

/// A square linear system A x = b, factorised by Gaussian elimination with complete pivoting. Equations that
/// depend on others are left out, and as many unknowns are zero: a consistent system is solved all the same.
/// Unknowns that no chain of entries connects are eliminated apart, and entries that are zero cost nothing:
/// what touches few others is solved for far less than the cube.
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
  struct Part {
    std::size_t size = 0, rank = 0;
    std::vector<double> lu;
    std::vector<std::size_t> row, column;  // the caller's at each place
    // While eliminating, of what is left: in each row the largest size, and the unknowns whose entries are
    // not zero; where each unknown's column will be.
    std::vector<double> largest;
    std::vector<std::vector<std::size_t>> entries;
    std::vector<std::size_t> place;
    void begin();
    void factor(double least);
    void bring_pivot(std::size_t from_row);
    void eliminate();
    void solve(std::span<double> b, std::span<double> work) const;
  };

  std::size_t size_ = 0, rank_ = 0;
  std::vector<double> original_;
  MatrixParts division_;
  std::vector<Part> parts_;  // as many as there are; further ones keep their room
  mutable std::vector<double> work_;
  std::vector<double> residual_;
};

}  // namespace plumb
