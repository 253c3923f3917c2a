#pragma once

#include <memory_resource>
#include <span>
#include <utility>
#include <vector>

namespace plumb {

/// Elimination order of blocks of constraint rows: reverse Cuthill-McKee (1969) on the graph whose edges join
/// blocks that share a body.
class BlockOrder {
 public:
  explicit BlockOrder(std::pmr::memory_resource* memory = std::pmr::get_default_resource())
      : body_blocks_(memory), neighbours_(memory), order_(memory), mark_(memory) {}

  /// Computes the order. `body_blocks`: body and block, for each dynamic body of each block.
  void compute(int blocks, std::span<const std::pair<int, int>> body_blocks);

  /// Blocks in elimination order.
  std::span<const int> sequence() const { return order_; }
  std::span<const int> neighbours(int block) const { return neighbours_[block]; }

 private:
  std::pmr::vector<std::pair<int, int>> body_blocks_;
  std::pmr::vector<std::pmr::vector<int>> neighbours_;
  std::pmr::vector<int> order_, mark_;
};

}  // namespace plumb
