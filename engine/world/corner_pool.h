#pragma once

#include <span>
#include <tuple>
#include <vector>

#include "engine/geometry/convex.h"

namespace plumb {

/// The corners of all shapes side by side. Runs that are given back are used again for runs of the same
/// length.
template <class Real>
class CornerPool {
 public:
  int add(std::span<const Corner<Real>> corners) {
    const int count = static_cast<int>(corners.size());
    std::vector<int>& free = free_of(count);
    int first = static_cast<int>(corners_.size());
    if (free.empty()) {
      corners_.resize(corners_.size() + corners.size());
    } else {
      first = free.back();
      free.pop_back();
    }
    for (int i = 0; i < count; ++i) corners_[first + i] = corners[i];
    return first;
  }
  void remove(int first, int count) { free_of(count).push_back(first); }

  const Corner<Real>* data() const { return corners_.data(); }
  Corner<Real>& operator[](int i) { return corners_[i]; }

  /// Corners, and where free runs begin, by their length: all that there is, for snapshots.
  auto parts() { return std::tie(corners_, free_); }
  auto parts() const { return std::tie(corners_, free_); }

 private:
  std::vector<int>& free_of(int count) {
    const std::size_t length = static_cast<std::size_t>(count);
    if (free_.size() <= length) free_.resize(length + 1);
    return free_[length];
  }

  std::vector<Corner<Real>> corners_;
  std::vector<std::vector<int>> free_;
};

}  // namespace plumb
