#include "engine/linear_algebra/block_order.h"

#include <algorithm>
#include <cassert>

namespace plumb {

void BlockOrder::find(int blocks, std::span<const std::pair<int, int>> ends) {
  assert(blocks >= 0);
  assert(std::all_of(ends.begin(), ends.end(),
                     [&](const auto& end) { return end.second >= 0 && end.second < blocks; }));
  neighbours_.resize(std::max<std::size_t>(neighbours_.size(), blocks));
  for (int i = 0; i < blocks; ++i) neighbours_[i].clear();
  ends_.assign(ends.begin(), ends.end());
  std::sort(ends_.begin(), ends_.end());
  for (std::size_t i = 0; i < ends_.size(); ++i) {
    for (std::size_t j = i + 1; j < ends_.size() && ends_[j].first == ends_[i].first; ++j) {
      neighbours_[ends_[i].second].push_back(ends_[j].second);
      neighbours_[ends_[j].second].push_back(ends_[i].second);
    }
  }
  // Orders breadth first from a block at the edge of the graph: the last block that a search from any start
  // reaches.
  degree_.assign(blocks, 0);
  const auto walk = [&](int start, int mark) {
    const std::size_t begin = sequence_.size();
    sequence_.push_back(start);
    degree_[start] = mark;
    for (std::size_t next = begin; next < sequence_.size(); ++next) {
      for (const int other : neighbours_[sequence_[next]]) {
        if (degree_[other] >= mark) continue;
        degree_[other] = mark;
        sequence_.push_back(other);
      }
    }
    return sequence_.back();
  };
  sequence_.clear();
  for (int start = 0; start < blocks; ++start) {
    if (degree_[start] != 0) continue;
    const std::size_t begin = sequence_.size();
    const int edge = walk(start, 1);
    sequence_.resize(begin);
    walk(edge, 2);
  }
  std::reverse(sequence_.begin(), sequence_.end());
  assert(static_cast<int>(sequence_.size()) == blocks);
}

}  // namespace plumb
