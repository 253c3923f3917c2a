#include "engine/linear_algebra/matrix_components.h"

#include <algorithm>
#include <cassert>

namespace plumb {

void MatrixComponents::compute(std::size_t size, std::span<const double> matrix) {
  assert(matrix.size() == size * size);
  size_ = size;
  visited_.assign(size, 0);
  rows_.clear();
  starts_.assign(1, 0);
  for (std::size_t first = 0; first < size; ++first) {
    if (visited_[first]) continue;
    visited_[first] = 1;
    rows_.push_back(first);
    for (std::size_t next = starts_.back(); next < rows_.size(); ++next) {
      const std::size_t i = rows_[next];
      for (std::size_t j = 0; j < size; ++j) {
        if (visited_[j] || (matrix[i * size + j] == 0 && matrix[j * size + i] == 0)) continue;
        visited_[j] = 1;
        rows_.push_back(j);
      }
    }
    std::sort(rows_.begin() + static_cast<std::ptrdiff_t>(starts_.back()), rows_.end());
    starts_.push_back(rows_.size());
  }
}

void MatrixComponents::extract(std::size_t p, std::span<const double> matrix,
                               std::vector<double>& out) const {
  assert(p < count() && matrix.size() == size_ * size_);
  if (count() == 1) return out.assign(matrix.begin(), matrix.end());
  out.clear();
  for (const std::size_t i : component(p)) {
    for (const std::size_t j : component(p)) out.push_back(matrix[i * size_ + j]);
  }
}

}  // namespace plumb
