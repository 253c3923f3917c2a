#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

namespace plumb {

/// Computes 64-bit FNV-1a (Fowler, Noll, Vo) over words of eight bytes instead of single bytes; the rest byte
/// by byte. After each word, the upper half is folded onto the lower one: multiplication moves bits only
/// upwards, so two flipped sign bits would otherwise cancel. Each round is a bijection, so bytes of the same
/// length that differ in one word have different sums.
inline std::uint64_t checksum(std::span<const std::byte> bytes) {
  constexpr std::uint64_t kPrime = 0x100000001B3u;
  std::uint64_t hash = 0xCBF29CE484222325u;
  std::size_t at = 0;
  for (; at + 8 <= bytes.size(); at += 8) {
    std::uint64_t word;
    std::memcpy(&word, bytes.data() + at, 8);
    hash = (hash ^ word) * kPrime;
    hash ^= hash >> 32;
  }
  for (; at < bytes.size(); ++at) hash = (hash ^ std::to_integer<std::uint64_t>(bytes[at])) * kPrime;
  return hash;
}

}  // namespace plumb
