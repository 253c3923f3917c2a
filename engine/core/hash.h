#pragma once

#include <bit>
#include <cstdint>

namespace plumb {

/// 64-bit FNV-1a (Fowler, Noll and Vo) over bytes, the least significant of a word first.
class Fnv1a {
 public:
  /// Adds a byte, or a word of more bits at once.
  void add(std::uint64_t word) { value_ = (value_ ^ word) * 0x100000001b3u; }
  void add(double number) {
    const auto bits = std::bit_cast<std::uint64_t>(number);
    for (int shift = 0; shift < 64; shift += 8) add(bits >> shift & 0xFF);
  }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325u;
};

/// Applies the finalizer of MurmurHash3 (Appleby): each bit of the word changes each bit of the result with a
/// probability near one half.
inline std::uint64_t mixed_bits(std::uint64_t word) {
  word = (word ^ (word >> 33)) * 0xff51afd7ed558ccdu;
  word = (word ^ (word >> 33)) * 0xc4ceb9fe1a85ec53u;
  return word ^ (word >> 33);
}

}  // namespace plumb
