#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace plumb {

/// Connected components of a square matrix's nonzero entries. They are independent and may be solved
/// separately, at the sum of their cubes.
class MatrixComponents {
 public:
  /// Finds the components.
  void compute(std::size_t size, std::span<const double> matrix);

  std::size_t count() const { return starts_.size() - 1; }
  /// Returns rows in ascending order; components are ordered by their first row.
  std::span<const std::size_t> component(std::size_t p) const {
    return std::span(rows_).subspan(starts_[p], starts_[p + 1] - starts_[p]);
  }
  /// Extracts the component's matrix, row by row, from the whole one.
  void extract(std::size_t p, std::span<const double> matrix, std::vector<double>& out) const;

 private:
  std::size_t size_ = 0;
  std::vector<std::size_t> rows_, starts_{0};  // component by component; start of each, and the end
  std::vector<char> visited_;
};

}  // namespace plumb
