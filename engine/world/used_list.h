#pragma once

#include <tuple>
#include <vector>

#include "engine/scene/room.h"

namespace plumb {

/// A value for each of a number of things, all T{} and without room until one of them is used.
template <class T>
class UsedList {
 public:
  bool used() const { return !items_.empty(); }
  /// Not used: T{}.
  T get(int i) const { return used() ? items_[i] : T{}; }
  /// From now on there is room for all `size` things.
  T& at(int i, int size) {
    make_room(items_, size);
    return items_[i];
  }
  /// Makes room for `size` things, where one is used or is going to be.
  void ensure(int size, bool going_to_be) {
    if (used() || going_to_be) ensure_room(items_, static_cast<std::size_t>(size));
  }
  /// To be called when there are `size` things and number `i` is new.
  void renew(int i, int size) {
    if (used()) at(i, size) = T{};
  }
  T* data() { return items_.data(); }

  /// For snapshots.
  auto parts() { return std::tie(items_); }
  auto parts() const { return std::tie(items_); }

 private:
  std::vector<T> items_;
};

}  // namespace plumb
