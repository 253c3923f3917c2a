#pragma once

#include <cstring>

#include "engine/math/lane_rows.h"
#include "engine/math/lanes.h"

namespace plumb {

/// Four numbers, in registers of 16 bytes that all processors have.
template <class Real>
using Four = Lanes<Real, 4>;

/// Returns true if a > b in all four lanes.
template <class Real>
[[gnu::always_inline]] inline bool all_greater(const Four<Real>& a, const Four<Real>& b) {
#ifdef PLUMB_VECTORS
  bool all = true;
  for (int k = 0; k < Four<Real>::kParts; ++k) {
    const auto greater = a.part[k] > b.part[k];  // lanes of ones or zeros
    long long half[2];
    std::memcpy(half, &greater, sizeof half);
    all = all && (half[0] & half[1]) == -1;
  }
  return all;
#else
  for (int k = 0; k < 4; ++k)
    if (!(a.part[k] > b.part[k])) return false;
  return true;
#endif
}

/// Loads four numbers from each of four addresses, multiples of 16 bytes, and transposes: the four firsts,
/// the four seconds and so on.
template <class Real>
[[gnu::always_inline]] inline void load_rows(const Real* const (&from)[4], Four<Real> (&out)[4]) {
  load_records<true>(
      [&](int i) __attribute__((always_inline)) { return from[i]; }, out);
}

/// Loads two numbers from each of four addresses: the four firsts and the four seconds.
template <class Real>
[[gnu::always_inline]] inline void load_pairs(const Real* const (&from)[4], Four<Real> (&out)[2]) {
#ifdef PLUMB_VECTORS
  using Part = typename Four<Real>::Part;
  if constexpr (sizeof(Real) == 4) {
    typedef double Pairs __attribute__((vector_size(16)));  // pairs of floats, not numbers
    double pair[4];
    for (int i = 0; i < 4; ++i) std::memcpy(&pair[i], from[i], sizeof(double));
    const Part low = reinterpret_cast<Part>(Pairs{pair[0], pair[1]});
    const Part high = reinterpret_cast<Part>(Pairs{pair[2], pair[3]});
    out[0].part[0] = __builtin_shufflevector(low, high, 0, 2, 4, 6);
    out[1].part[0] = __builtin_shufflevector(low, high, 1, 3, 5, 7);
    return;
  }
#endif
  Real lanes[2][4];
  for (int i = 0; i < 4; ++i) lanes[0][i] = from[i][0], lanes[1][i] = from[i][1];
  for (int k = 0; k < 2; ++k) out[k] = Four<Real>::load(lanes[k]);
}

}  // namespace plumb
