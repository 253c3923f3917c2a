#pragma once

#include <algorithm>
#include <cassert>
#include <vector>

namespace plumb {

/// Disjoint sets of small integers; the smallest member represents its set.
class UnionFind {
 public:
  /// Creates a set for each of 0 .. size - 1, in the caller's memory.
  UnionFind(std::vector<int>& parents, int size) : parents_(parents) {
    parents_.resize(static_cast<std::size_t>(size));
    for (int i = 0; i < size; ++i) parents_[i] = i;
  }
  int find(int i) {
    assert(i >= 0 && i < static_cast<int>(parents_.size()));
    while (parents_[i] != i) i = parents_[i] = parents_[parents_[i]];
    return i;
  }
  void join(int a, int b) {
    a = find(a), b = find(b);
    if (a != b) parents_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<int>& parents_;
};

}  // namespace plumb
