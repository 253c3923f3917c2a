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
      : ends_(memory), neighbours_(memory), sequence_(memory), degree_(memory) {}

  /// `ends`: body and block, for each dynamic body of each block.
  void find(int blocks, std::span<const std::pair<int, int>> ends);

  /// Blocks in elimination order.
  std::span<const int> sequence() const { return sequence_; }
  std::span<const int> neighbours(int block) const { return neighbours_[block]; }
  /// Pairs of body and block, sorted by body.
  std::span<const std::pair<int, int>> ends() const { return ends_; }

 private:
  std::pmr::vector<std::pair<int, int>> ends_;
  std::pmr::vector<std::pmr::vector<int>> neighbours_;
  std::pmr::vector<int> sequence_, degree_;
};

}  // namespace plumb
