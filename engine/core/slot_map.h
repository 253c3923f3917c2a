#pragma once

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <tuple>
#include <utility>
#include <vector>

#include "engine/core/capacity.h"

namespace plumb {

/// Items in slots with stable indices. A free slot is reused, the last freed first, with the next generation.
/// An odd generation is in use.
template <class T>
class SlotMap {
 public:
  /// Reserves memory for `more` items, so that adding them, and removing any, does not allocate.
  void reserve_more(std::size_t more) {
    const std::size_t wanted = items_.size() + more - std::min(more, free_.size());
    ensure_capacity(items_, wanted), ensure_capacity(generations_, wanted), ensure_capacity(free_, wanted);
  }
  /// Changes nothing if memory runs out.
  int add(T value) {
    reserve_more(1);
    int index;
    if (free_.empty()) {
      index = static_cast<int>(items_.size());
      items_.push_back(std::move(value));
      generations_.push_back(1);
    } else {
      index = free_.back();
      assert(!used(index));
      free_.pop_back();
      items_[index] = std::move(value);
      ++generations_[index];
    }
    return index;
  }
  void remove(int index) {
    assert(used(index));
    items_[index] = T{};
    ++generations_[index];
    free_.push_back(index);
  }

  T& operator[](int index) { return items_[index]; }
  const T& operator[](int index) const { return items_[index]; }

  /// Returns the number of slots, in use or free; indices are below it.
  int size() const { return static_cast<int>(items_.size()); }
  int count() const { return static_cast<int>(items_.size() - free_.size()); }
  bool used(int index) const { return (generations_[index] & 1) != 0; }
  std::uint32_t generation(int index) const { return generations_[index]; }
  bool holds(std::uint32_t index, std::uint32_t generation) const {
    return index < items_.size() && generations_[index] == generation && (generation & 1) != 0;
  }

  template <class Visit>
  void for_each(Visit&& visit) {
    for (int i = 0; i < size(); ++i) {
      if (used(i)) visit(i, items_[i]);
    }
  }

  /// Returns items, generations and free slots: the whole state, for snapshots.
  auto parts() { return std::tie(items_, generations_, free_); }
  auto parts() const { return std::tie(items_, generations_, free_); }

 private:
  std::vector<T> items_;
  std::vector<std::uint32_t> generations_;
  std::vector<int> free_;
};

}  // namespace plumb
