#pragma once

#include <cstddef>
#include <vector>

namespace plumb {

/// Queue in blocks, filled and then consumed as a whole. The memory of one block is kept, so that later steps
/// allocate nothing. More, as for a million contacts that begin in a scene's first step, is freed while it is
/// consumed.
template <class T>
class ChunkedBuffer {
 public:
  void push_back(const T& value) {
    if (blocks_.empty() || blocks_.back().size() == kBlock) blocks_.emplace_back();
    blocks_.back().push_back(value);
  }

  /// Calls `visit(value)` for each element in the order of insertion, and empties the list.
  template <class Visit>
  void use_up(Visit&& visit) {
    for (std::size_t i = 0; i < blocks_.size(); ++i) {
      for (T& value : blocks_[i]) visit(value);
      if (i > 0) blocks_[i] = {};
    }
    clear();
  }

  void clear() {
    if (blocks_.empty()) return;
    blocks_.resize(1);
    blocks_[0].clear();
  }

 private:
  static constexpr std::size_t kBlock = 16384;

  std::vector<std::vector<T>> blocks_;
};

}  // namespace plumb
