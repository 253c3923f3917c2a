#pragma once

#include <cstddef>
#include <vector>

namespace plumb {

/// A list that is filled and used up, in blocks. The room of one block stays, so that steps allocate nothing
/// once warm; what a burst takes beyond it (a million contacts that begin in a scene's first step) is given
/// back as it is used up.
template <class T>
class BurstList {
 public:
  void push_back(const T& value) {
    if (blocks_.empty() || blocks_.back().size() == kBlock) blocks_.emplace_back();
    blocks_.back().push_back(value);
  }

  /// `visit(value)` for each, in the order in which they came.
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
