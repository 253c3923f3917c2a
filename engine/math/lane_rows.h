#pragma once

#include "engine/math/lanes.h"

#ifdef PLUMB_VECTORS

/// Moves records of four numbers between memory and lanes: lane i of number k is number k of record i.
namespace plumb {

/// Transposes blocks of four by four: of eight lanes, the first four and the last four.
template <class Real, int kCount, int kBytes>
[[gnu::always_inline]] inline void transpose_fours(const Lanes<Real, kCount, kBytes> (&in)[4],
                                                   Lanes<Real, kCount, kBytes> (&out)[4]) {
  static_assert(in[0].kParts == 1 && (kCount == 4 || kCount == 8));
  const auto &a = in[0].part[0], &b = in[1].part[0], &c = in[2].part[0], &d = in[3].part[0];
  if constexpr (kCount == 8) {
    const auto low_ab = __builtin_shufflevector(a, b, 0, 8, 1, 9, 4, 12, 5, 13);
    const auto low_cd = __builtin_shufflevector(c, d, 0, 8, 1, 9, 4, 12, 5, 13);
    const auto high_ab = __builtin_shufflevector(a, b, 2, 10, 3, 11, 6, 14, 7, 15);
    const auto high_cd = __builtin_shufflevector(c, d, 2, 10, 3, 11, 6, 14, 7, 15);
    out[0].part[0] = __builtin_shufflevector(low_ab, low_cd, 0, 1, 8, 9, 4, 5, 12, 13);
    out[1].part[0] = __builtin_shufflevector(low_ab, low_cd, 2, 3, 10, 11, 6, 7, 14, 15);
    out[2].part[0] = __builtin_shufflevector(high_ab, high_cd, 0, 1, 8, 9, 4, 5, 12, 13);
    out[3].part[0] = __builtin_shufflevector(high_ab, high_cd, 2, 3, 10, 11, 6, 7, 14, 15);
  } else if constexpr (sizeof(Real) == 8) {  // registers of two halves: cross them last
    const auto even_ab = __builtin_shufflevector(a, b, 0, 4, 2, 6);
    const auto even_cd = __builtin_shufflevector(c, d, 0, 4, 2, 6);
    const auto odd_ab = __builtin_shufflevector(a, b, 1, 5, 3, 7);
    const auto odd_cd = __builtin_shufflevector(c, d, 1, 5, 3, 7);
    out[0].part[0] = __builtin_shufflevector(even_ab, even_cd, 0, 1, 4, 5);
    out[1].part[0] = __builtin_shufflevector(odd_ab, odd_cd, 0, 1, 4, 5);
    out[2].part[0] = __builtin_shufflevector(even_ab, even_cd, 2, 3, 6, 7);
    out[3].part[0] = __builtin_shufflevector(odd_ab, odd_cd, 2, 3, 6, 7);
  } else {
    const auto low_ab = __builtin_shufflevector(a, b, 0, 4, 1, 5);
    const auto low_cd = __builtin_shufflevector(c, d, 0, 4, 1, 5);
    const auto high_ab = __builtin_shufflevector(a, b, 2, 6, 3, 7);
    const auto high_cd = __builtin_shufflevector(c, d, 2, 6, 3, 7);
    out[0].part[0] = __builtin_shufflevector(low_ab, low_cd, 0, 1, 4, 5);
    out[1].part[0] = __builtin_shufflevector(low_ab, low_cd, 2, 3, 6, 7);
    out[2].part[0] = __builtin_shufflevector(high_ab, high_cd, 0, 1, 4, 5);
    out[3].part[0] = __builtin_shufflevector(high_ab, high_cd, 2, 3, 6, 7);
  }
}

/// Loads a record from each of `address(0)` to `address(kCount - 1)`, multiples of 16 bytes.
template <class Real, int kCount, int kBytes, class Address>
[[gnu::always_inline]] inline void load_records(const Address& address, Lanes<Real, kCount, kBytes> (&out)[4]) {
  using Number = Lanes<Real, kCount, kBytes>;
  Number rows[4];
  for (int i = 0; i < 4; ++i) {
    if constexpr (kCount == 8) {
      const auto low = Lanes<Real, 4>::load_aligned(address(i)).part[0];
      const auto high = Lanes<Real, 4>::load_aligned(address(i + 4)).part[0];
      rows[i].part[0] = __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
    } else {
      rows[i] = Number::load_aligned(address(i));
    }
  }
  transpose_fours(rows, out);
}

/// Stores them.
template <class Real, int kCount, int kBytes, class Address>
[[gnu::always_inline]] inline void store_records(const Address& address,
                                                 const Lanes<Real, kCount, kBytes> (&in)[4]) {
  Lanes<Real, kCount, kBytes> rows[4];
  transpose_fours(in, rows);
  for (int i = 0; i < 4; ++i) {
    if constexpr (kCount == 8) {
      const auto& row = rows[i].part[0];
      Lanes<Real, 4> low, high;
      low.part[0] = __builtin_shufflevector(row, row, 0, 1, 2, 3);
      high.part[0] = __builtin_shufflevector(row, row, 4, 5, 6, 7);
      low.store_aligned(address(i)), high.store_aligned(address(i + 4));
    } else {
      rows[i].store_aligned(address(i));
    }
  }
}

}  // namespace plumb

#endif
