#include "engine/linear_algebra/block_order.h"

#include <algorithm>
#include <cassert>

namespace plumb {

void BlockOrder::compute(int blocks, std::span<const std::pair<int, int>> body_blocks) {
  assert(blocks >= 0);
  assert(std::all_of(body_blocks.begin(), body_blocks.end(),
                     [&](const auto& each) { return each.second >= 0 && each.second < blocks; }));
  neighbours_.resize(std::max<std::size_t>(neighbours_.size(), blocks));
  for (int i = 0; i < blocks; ++i) neighbours_[i].clear();
  body_blocks_.assign(body_blocks.begin(), body_blocks.end());
  std::sort(body_blocks_.begin(), body_blocks_.end());
  for (std::size_t i = 0; i < body_blocks_.size(); ++i) {
    for (std::size_t j = i + 1; j < body_blocks_.size() && body_blocks_[j].first == body_blocks_[i].first;
         ++j) {
      neighbours_[body_blocks_[i].second].push_back(body_blocks_[j].second);
      neighbours_[body_blocks_[j].second].push_back(body_blocks_[i].second);
    }
  }
  // Orders breadth first from a pseudo-peripheral block: the last one that a search from any start reaches.
  mark_.assign(blocks, 0);
  const auto search = [&](int start, int mark) {
    const std::size_t begin = order_.size();
    order_.push_back(start);
    mark_[start] = mark;
    for (std::size_t next = begin; next < order_.size(); ++next) {
      for (const int other : neighbours_[order_[next]]) {
        if (mark_[other] >= mark) continue;
        mark_[other] = mark;
        order_.push_back(other);
      }
    }
    return order_.back();
  };
  order_.clear();
  for (int start = 0; start < blocks; ++start) {
    if (mark_[start] != 0) continue;
    const std::size_t begin = order_.size();
    const int edge = search(start, 1);
    order_.resize(begin);
    search(edge, 2);
  }
  std::reverse(order_.begin(), order_.end());
  assert(static_cast<int>(order_.size()) == blocks);
}

}  // namespace plumb
