#pragma once

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <vector>

namespace plumb {

/// Vectors with more items than this grow by a quarter instead of doubling: at most a fifth of the capacity
/// is then unused, and each item is moved four times on average.
inline constexpr std::size_t kDoublingLimit = 1024;

/// Returns the capacity to grow to, for `size` items when the present capacity is `capacity`.
inline std::size_t grown_capacity(std::size_t capacity, std::size_t size) {
  return std::max(size, capacity < kDoublingLimit ? 2 * capacity : capacity + capacity / 4);
}

/// Reserves capacity for `wanted` items, so that the vector grows to them without an allocation.
template <class T>
void ensure_capacity(std::vector<T>& list, std::size_t wanted) {
  if (wanted > list.capacity()) list.reserve(grown_capacity(list.capacity(), wanted));
}

/// Resizes a vector with this growth.
template <class T>
void resize_with_growth(std::vector<T>& list, int size) {
  assert(size >= 0);
  const std::size_t wanted = static_cast<std::size_t>(size);
  ensure_capacity(list, wanted);
  list.resize(wanted);
}

/// Appends an item with this growth.
template <class T>
void append(std::vector<T>& list, const T& item) {
  if (list.size() == list.capacity()) {
    const T kept = item;  // a copy: `item` may be in the list
    list.reserve(grown_capacity(list.capacity(), list.size() + 1));
    list.push_back(kept);
    return;
  }
  list.push_back(item);
}

}  // namespace plumb
