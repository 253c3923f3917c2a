#pragma once

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace plumb {

/// A set of small non-negative integers, one bit each; grows with the largest member. Integers beyond its
/// size are not in it.
class BitSet {
 public:
  static constexpr int kWordBits = 64;

  explicit BitSet(int size = 0) { reserve(size); }

  /// Reserves capacity for 0 .. size - 1, so that setting them allocates nothing; never shrinks.
  void reserve(int size) {
    const std::size_t words = (static_cast<std::size_t>(size) + kWordBits - 1) / kWordBits;
    if (words > words_.size()) words_.resize(words, 0);
  }
  /// Returns the capacity, for 0 .. size() - 1: a multiple of the word's bits.
  int size() const { return static_cast<int>(words_.size()) * kWordBits; }

  void set(int i) {
    assert(i >= 0);
    if (i >= size()) grow(i);
    words_[word(i)] |= bit(i);
  }
  void reset(int i) {
    assert(i >= 0);
    if (i < size()) words_[word(i)] &= ~bit(i);
  }
  bool test(int i) const { return i < size() && (words_[word(i)] & bit(i)) != 0; }

  int count() const {
    int sum = 0;
    for (const std::uint64_t bits : words_) sum += std::popcount(bits);
    return sum;
  }
  bool none() const {
    return std::all_of(words_.begin(), words_.end(), [](std::uint64_t bits) { return bits == 0; });
  }

  /// Empties the set; its capacity stays.
  void clear() { std::fill(words_.begin(), words_.end(), 0); }

  BitSet& operator|=(const BitSet& other) {
    reserve(other.size());
    for (std::size_t i = 0; i < other.words_.size(); ++i) words_[i] |= other.words_[i];
    return *this;
  }

  /// Calls visit(i) for each member in ascending order. `visit` may change the set: changes up to i's word do
  /// not affect this loop, changes to later words do.
  template <class Visit>
  void for_each(Visit&& visit) const {
    for (std::size_t w = 0; w < words_.size(); ++w)
      for (std::uint64_t bits = words_[w]; bits != 0; bits &= bits - 1)
        visit(static_cast<int>(w) * kWordBits + std::countr_zero(bits));
  }

  const std::vector<std::uint64_t>& words() const { return words_; }
  std::vector<std::uint64_t>& words() { return words_; }

 private:
  static std::size_t word(int i) { return static_cast<std::size_t>(i) / kWordBits; }
  static std::uint64_t bit(int i) { return std::uint64_t{1} << (static_cast<unsigned>(i) % kWordBits); }
  void grow(int i) { reserve(std::max(i + 1, 2 * size())); }

  std::vector<std::uint64_t> words_;
};

}  // namespace plumb
