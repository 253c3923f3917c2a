#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace plumb {

/// Connected components of a square matrix's nonzero entries. They are independent and may be solved
/// separately, at the sum of their cubes.
class MatrixComponents {
 public:
  void find(std::size_t size, std::span<const double> matrix);

  std::size_t count() const { return starts_.size() - 1; }
  /// Returns rows in ascending order; parts are ordered by their first row.
  std::span<const std::size_t> part(std::size_t p) const {
    return std::span(rows_).subspan(starts_[p], starts_[p + 1] - starts_[p]);
  }
  /// Extracts the part's matrix, row by row, from the whole one.
  void take(std::size_t p, std::span<const double> matrix, std::vector<double>& out) const;

 private:
  std::size_t size_ = 0;
  std::vector<std::size_t> rows_, starts_{0};  // part by part; start of each, and the end
  std::vector<char> found_;
};

}  // namespace plumb
