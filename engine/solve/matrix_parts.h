#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace plumb {

/// The rows and columns of a square matrix by what entries other than zero connect: parts that know nothing
/// of each other may be solved apart, at the sum of their cubes.
class MatrixParts {
 public:
  void find(std::size_t size, std::span<const double> matrix);

  std::size_t count() const { return starts_.size() - 1; }
  /// Ascending; parts by their first row.
  std::span<const std::size_t> part(std::size_t p) const {
    return std::span(rows_).subspan(starts_[p], starts_[p + 1] - starts_[p]);
  }
  /// The part's own matrix, row after row, out of the whole one.
  void take(std::size_t p, std::span<const double> matrix, std::vector<double>& out) const;

 private:
  std::size_t size_ = 0;
  std::vector<std::size_t> rows_, starts_{0};  // part after part; where each begins, and the end
  std::vector<char> found_;
};

}  // namespace plumb
