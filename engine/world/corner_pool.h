#pragma once

#include <map>
#include <span>
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
    std::vector<int>& free = free_[count];
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
  void remove(int first, int count) { free_[count].push_back(first); }

  const Corner<Real>* data() const { return corners_.data(); }
  Corner<Real>& operator[](int i) { return corners_[i]; }

 private:
  std::vector<Corner<Real>> corners_;
  std::map<int, std::vector<int>> free_;
};

}  // namespace plumb
