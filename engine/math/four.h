#pragma once

#include <cstring>

namespace plumb {

/// Four numbers that are treated alike, lane by lane: each lane gives the bits that the same sums of single
/// numbers give. With PLUMB_SCALAR, or a compiler without vectors, it is an array.
template <class Real>
struct Four {
#if defined(__GNUC__) && !defined(PLUMB_SCALAR)
  typedef Real Part __attribute__((vector_size(16)));
#else
  using Part = Real;
#endif
  static constexpr int kParts = static_cast<int>(4 * sizeof(Real) / sizeof(Part));
  Part part[kParts];

  static Four load(const Real* from) {
    Four out;
    std::memcpy(out.part, from, 4 * sizeof(Real));
    return out;
  }
  /// The same number in all lanes.
  static Four spread(Real value) {
    Four out;
    for (int k = 0; k < kParts; ++k) out.part[k] = value - Part{};
    return out;
  }
  void store(Real* to) const { std::memcpy(to, part, 4 * sizeof(Real)); }

  friend Four operator+(const Four& a, const Four& b) {
    Four out;
    for (int k = 0; k < kParts; ++k) out.part[k] = a.part[k] + b.part[k];
    return out;
  }
  friend Four operator-(const Four& a, const Four& b) {
    Four out;
    for (int k = 0; k < kParts; ++k) out.part[k] = a.part[k] - b.part[k];
    return out;
  }
  friend Four operator*(const Four& a, const Four& b) {
    Four out;
    for (int k = 0; k < kParts; ++k) out.part[k] = a.part[k] * b.part[k];
    return out;
  }
  friend Four least(const Four& a, const Four& b) {
    Four out;
    for (int k = 0; k < kParts; ++k) out.part[k] = a.part[k] < b.part[k] ? a.part[k] : b.part[k];
    return out;
  }
};

/// Rows become columns: lane i of out k is lane k of row i.
template <class Real>
inline void transpose(const Four<Real> (&row)[4], Four<Real> (&out)[4]) {
#if defined(__GNUC__) && !defined(PLUMB_SCALAR)
  using Part = typename Four<Real>::Part;
  if constexpr (sizeof(Real) == 4) {
    const Part low01 = __builtin_shufflevector(row[0].part[0], row[1].part[0], 0, 4, 1, 5);
    const Part low23 = __builtin_shufflevector(row[2].part[0], row[3].part[0], 0, 4, 1, 5);
    const Part high01 = __builtin_shufflevector(row[0].part[0], row[1].part[0], 2, 6, 3, 7);
    const Part high23 = __builtin_shufflevector(row[2].part[0], row[3].part[0], 2, 6, 3, 7);
    out[0].part[0] = __builtin_shufflevector(low01, low23, 0, 1, 4, 5);
    out[1].part[0] = __builtin_shufflevector(low01, low23, 2, 3, 6, 7);
    out[2].part[0] = __builtin_shufflevector(high01, high23, 0, 1, 4, 5);
    out[3].part[0] = __builtin_shufflevector(high01, high23, 2, 3, 6, 7);
  } else {
    for (int k = 0; k < 2; ++k)  // columns 2 k and 2 k + 1
      for (int i = 0; i < 2; ++i) {
        out[2 * k].part[i] = __builtin_shufflevector(row[2 * i].part[k], row[2 * i + 1].part[k], 0, 2);
        out[2 * k + 1].part[i] = __builtin_shufflevector(row[2 * i].part[k], row[2 * i + 1].part[k], 1, 3);
      }
  }
#else
  for (int k = 0; k < 4; ++k)
    for (int i = 0; i < 4; ++i) out[k].part[i] = row[i].part[k];
#endif
}

}  // namespace plumb
