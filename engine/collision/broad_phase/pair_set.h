#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/core/hash.h"

namespace plumb {

/// A set of unordered pairs of non-negative integers. Open addressing with linear probing, at most half full;
/// erasing shifts later keys back (Knuth, The Art of Computer Programming 3, 6.4, algorithm R), so that no
/// tombstones accumulate. It cannot be iterated, so that the order of a hash table never affects a result.
class PairSet {
 public:
  /// Inserts the pair; returns false if it was in the set already.
  bool insert(int a, int b);
  /// Erases the pair; returns false if it was not in the set.
  bool erase(int a, int b);
  bool contains(int a, int b) const { return !keys_.empty() && keys_[find(key(a, b))] != kEmpty; }
  /// Prefetches the memory that contains(a, b) will read. (GCC 12 drops calls of a function that does nothing
  /// else, unless they are inlined first.)
  [[gnu::always_inline]] void prefetch(int a, int b) const {
    if (!keys_.empty()) __builtin_prefetch(&keys_[hash(key(a, b)) & (keys_.size() - 1)]);
  }

  int size() const { return size_; }
  /// Empties the set; its capacity stays.
  void clear();
  /// Reserves capacity for `pairs` pairs, so that inserting them allocates nothing.
  void reserve(int pairs);

  /// Returns the number of slots, of which at most half are used.
  int capacity() const { return static_cast<int>(keys_.size()); }
  /// Returns the mean number of slots probed to find a pair that is in the set.
  double mean_probes() const;

 private:
  using Key = std::uint64_t;
  static constexpr Key kEmpty = 0;
  static constexpr std::size_t kSmallest = 16;

  // Returns the pair as one number: the larger index in the upper half, plus one so that no pair is kEmpty.
  static Key key(int a, int b) {
    const auto low = static_cast<std::uint32_t>(a < b ? a : b);
    const auto high = static_cast<std::uint32_t>(a < b ? b : a);
    return (Key{high} + 1) << 32 | low;
  }

  // Mixes the key's bits, so that neighbouring indices do not probe each other's slots.
  static std::size_t hash(Key key) { return static_cast<std::size_t>(mixed_bits(key)); }

  // Returns the slot that holds `key`, or the empty one for it.
  std::size_t find(Key key) const {
    const std::size_t mask = keys_.size() - 1;
    std::size_t slot = hash(key) & mask;
    while (keys_[slot] != key && keys_[slot] != kEmpty) slot = (slot + 1) & mask;
    return slot;
  }

  void resize(std::size_t capacity);

  std::vector<Key> keys_;  // size is a power of two, or 0
  int size_ = 0;
};

}  // namespace plumb
