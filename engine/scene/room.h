#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace plumb {

/// Lists with more items than this grow by a quarter, not by doubling: what has no use yet is then at most a
/// fifth of their room, and each item is moved four times at most, on average, while they grow.
inline constexpr std::size_t kDoubled = 1024;

/// The capacity that a list of `size` items, which has room for `capacity`, is to grow to.
inline std::size_t grown_room(std::size_t capacity, std::size_t size) {
  return std::max(size, capacity < kDoubled ? 2 * capacity : capacity + capacity / 4);
}

/// Makes room for `wanted` items, so that a list gets as many without an allocation.
template <class T>
void ensure_room(std::vector<T>& list, std::size_t wanted) {
  if (wanted > list.capacity()) list.reserve(grown_room(list.capacity(), wanted));
}

/// Resizes a list.
template <class T>
void make_room(std::vector<T>& list, int size) {
  const std::size_t wanted = static_cast<std::size_t>(size);
  ensure_room(list, wanted);
  list.resize(wanted);
}

/// Puts an item at a list's end.
template <class T>
void append(std::vector<T>& list, const T& item) {
  if (list.size() == list.capacity()) {
    const T kept = item;  // which may be in the list
    list.reserve(grown_room(list.capacity(), list.size() + 1));
    list.push_back(kept);
    return;
  }
  list.push_back(item);
}

}  // namespace plumb
