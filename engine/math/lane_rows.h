#pragma once

#include "engine/math/lanes.h"

/// Moves records of four numbers between memory and lanes: lane i of number k is number k of record i.
namespace plumb {

#ifdef PLUMB_VECTORS

/// Transposes four by four: lane i of out k is lane k of row i. With eight lanes, the first four and the last
/// four are transposed separately.
template <class Real, int kCount, int kBytes>
[[gnu::always_inline]] inline void transpose(const Lanes<Real, kCount, kBytes> (&row)[4],
                                             Lanes<Real, kCount, kBytes> (&out)[4]) {
  static_assert(kCount == 4 || (kCount == 8 && kBytes == 32));
  constexpr int kParts = Lanes<Real, kCount, kBytes>::kParts;
  if constexpr (kParts == 2) {   // pairs of numbers
    for (int k = 0; k < 2; ++k)  // columns 2 k and 2 k + 1
      for (int i = 0; i < 2; ++i) {
        out[2 * k].part[i] = __builtin_shufflevector(row[2 * i].part[k], row[2 * i + 1].part[k], 0, 2);
        out[2 * k + 1].part[i] = __builtin_shufflevector(row[2 * i].part[k], row[2 * i + 1].part[k], 1, 3);
      }
    return;
  }
  const auto &a = row[0].part[0], &b = row[1].part[0], &c = row[2].part[0], &d = row[3].part[0];
  if constexpr (kParts == 1 && kCount == 8) {
    const auto low_ab = __builtin_shufflevector(a, b, 0, 8, 1, 9, 4, 12, 5, 13);
    const auto low_cd = __builtin_shufflevector(c, d, 0, 8, 1, 9, 4, 12, 5, 13);
    const auto high_ab = __builtin_shufflevector(a, b, 2, 10, 3, 11, 6, 14, 7, 15);
    const auto high_cd = __builtin_shufflevector(c, d, 2, 10, 3, 11, 6, 14, 7, 15);
    out[0].part[0] = __builtin_shufflevector(low_ab, low_cd, 0, 1, 8, 9, 4, 5, 12, 13);
    out[1].part[0] = __builtin_shufflevector(low_ab, low_cd, 2, 3, 10, 11, 6, 7, 14, 15);
    out[2].part[0] = __builtin_shufflevector(high_ab, high_cd, 0, 1, 8, 9, 4, 5, 12, 13);
    out[3].part[0] = __builtin_shufflevector(high_ab, high_cd, 2, 3, 10, 11, 6, 7, 14, 15);
  } else if constexpr (kParts == 1 && kBytes == 32) {  // two halves: exchange them last
    const auto even_ab = __builtin_shufflevector(a, b, 0, 4, 2, 6);
    const auto even_cd = __builtin_shufflevector(c, d, 0, 4, 2, 6);
    const auto odd_ab = __builtin_shufflevector(a, b, 1, 5, 3, 7);
    const auto odd_cd = __builtin_shufflevector(c, d, 1, 5, 3, 7);
    out[0].part[0] = __builtin_shufflevector(even_ab, even_cd, 0, 1, 4, 5);
    out[1].part[0] = __builtin_shufflevector(odd_ab, odd_cd, 0, 1, 4, 5);
    out[2].part[0] = __builtin_shufflevector(even_ab, even_cd, 2, 3, 6, 7);
    out[3].part[0] = __builtin_shufflevector(odd_ab, odd_cd, 2, 3, 6, 7);
  } else if constexpr (kParts == 1) {
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

/// Loads a record from each of `address(0)` to `address(kCount - 1)`: multiples of 16 bytes if `kAligned`.
template <bool kAligned, class Real, int kCount, int kBytes, class Address>
[[gnu::always_inline]] inline void load_records(const Address& address,
                                                Lanes<Real, kCount, kBytes> (&out)[4]) {
  using Number = Lanes<Real, kCount, kBytes>;
  using Record = Lanes<Real, 4>;
  Number rows[4];
  for (int i = 0; i < 4; ++i) {
    if constexpr (kCount == 8) {
      const Record low = kAligned ? Record::load_aligned(address(i)) : Record::load(address(i));
      const Record high = kAligned ? Record::load_aligned(address(i + 4)) : Record::load(address(i + 4));
      rows[i].part[0] = __builtin_shufflevector(low.part[0], high.part[0], 0, 1, 2, 3, 4, 5, 6, 7);
    } else {
      rows[i] = kAligned ? Number::load_aligned(address(i)) : Number::load(address(i));
    }
  }
  transpose(rows, out);
}

/// Stores them.
template <bool kAligned, class Real, int kCount, int kBytes, class Address>
[[gnu::always_inline]] inline void store_records(const Address& address,
                                                 const Lanes<Real, kCount, kBytes> (&in)[4]) {
  Lanes<Real, kCount, kBytes> rows[4];
  transpose(in, rows);
  for (int i = 0; i < 4; ++i) {
    if constexpr (kCount == 8) {
      const auto& row = rows[i].part[0];
      Lanes<Real, 4> low, high;
      low.part[0] = __builtin_shufflevector(row, row, 0, 1, 2, 3);
      high.part[0] = __builtin_shufflevector(row, row, 4, 5, 6, 7);
      kAligned ? low.store_aligned(address(i)) : low.store(address(i));
      kAligned ? high.store_aligned(address(i + 4)) : high.store(address(i + 4));
    } else {
      kAligned ? rows[i].store_aligned(address(i)) : rows[i].store(address(i));
    }
  }
}

#else

template <class Real, int kCount, int kBytes>
void transpose(const Lanes<Real, kCount, kBytes> (&row)[4], Lanes<Real, kCount, kBytes> (&out)[4]) {
  for (int first = 0; first < kCount; first += 4)
    for (int k = 0; k < 4; ++k)
      for (int i = 0; i < 4; ++i) out[k].part[first + i] = row[i].part[first + k];
}

template <bool kAligned, class Real, int kCount, int kBytes, class Address>
void load_records(const Address& address, Lanes<Real, kCount, kBytes> (&out)[4]) {
  for (int i = 0; i < kCount; ++i)
    for (int k = 0; k < 4; ++k) out[k].part[i] = address(i)[k];
}

template <bool kAligned, class Real, int kCount, int kBytes, class Address>
void store_records(const Address& address, const Lanes<Real, kCount, kBytes> (&in)[4]) {
  for (int i = 0; i < kCount; ++i)
    for (int k = 0; k < 4; ++k) address(i)[k] = in[k].part[i];
}

#endif

}  // namespace plumb
