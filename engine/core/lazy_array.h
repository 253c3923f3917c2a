#pragma once

#include <cassert>
#include <tuple>
#include <vector>

#include "engine/core/capacity.h"

namespace plumb {

/// A list of optional values, all T{} and without memory until one is used.
template <class T>
class LazyArray {
 public:
  bool used() const { return !items_.empty(); }
  /// Returns the value, T{} if the list is not used.
  T get(int i) const { return used() ? items_[i] : T{}; }
  /// Returns the value for writing; allocates memory for all `size` values.
  T& at(int i, int size) {
    assert(i >= 0 && i < size);
    resize_with_growth(items_, size);
    return items_[i];
  }
  /// Allocates memory for `size` values if one is in use already, or will be (`will_be_used`).
  void reserve(int size, bool will_be_used) {
    if (used() || will_be_used) ensure_capacity(items_, static_cast<std::size_t>(size));
  }
  /// Resets value `i`, that of a newly created item, to T{}; there are `size` items now.
  void reset(int i, int size) {
    if (used()) at(i, size) = T{};
  }
  T* data() { return items_.data(); }

  /// Returns the whole state, for snapshots.
  auto parts() { return std::tie(items_); }
  auto parts() const { return std::tie(items_); }

 private:
  std::vector<T> items_;
};

}  // namespace plumb
