#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <type_traits>
#include <utility>

/// Compiles a function for registers of 32 bytes, without fused operations.
#if defined(__x86_64__) || defined(__i386__)
#define PLUMB_AVX2 [[gnu::target("avx2")]]
#else
#define PLUMB_AVX2
#endif

namespace plumb {

/// Stores vector registers of `kBytes` bytes that hold numbers, or arrays of numbers with PLUMB_SCALAR or a
/// compiler without vectors.
#if defined(__GNUC__) && !defined(PLUMB_SCALAR)
#define PLUMB_VECTORS
template <class Real, int kBytes>
struct Register {
  typedef Real Part __attribute__((vector_size(kBytes)));
  using Mask = decltype(Part{} < Part{});             // all bits of a lane are ones or zeros
  struct [[gnu::packed, gnu::may_alias]] Unaligned {  // numbers in memory, which may alias others
    Part part;
  };
  typedef long long Words __attribute__((vector_size(kBytes)));
};
#else
template <class Real, int kBytes>
struct Register {
  using Part = Real;
  using Mask = bool;
  struct Unaligned {
    Part part;
  };
};
#endif

/// `kCount` truth values, one for each lane.
template <class Real, int kCount, int kBytes>
struct LaneMask {
  static constexpr int kParts =
      static_cast<int>(kCount * sizeof(Real) / sizeof(typename Register<Real, kBytes>::Part));
  typename Register<Real, kBytes>::Mask part[kParts];
};

/// `kCount` numbers processed lane by lane, in registers of `kBytes` bytes: each lane gives the same bits as
/// scalar code. Everything is inlined, because functions compiled for different register widths pass vectors
/// differently.
template <class Real, int kCount, int kBytes = 16>
struct Lanes {
  using Number = Real;
  using Registers = Register<Real, kBytes>;
  using Part = typename Registers::Part;
  using Mask = LaneMask<Real, kCount, kBytes>;
  static constexpr int kLanes = kCount;
  static constexpr int kParts = Mask::kParts;
  /// Needs explicit alignment: without AVX, g++ aligns wide vectors to 16 bytes.
  alignas(Part) alignas(kParts == kCount ? alignof(Part) : kBytes) Part part[kParts];

  Lanes() = default;
  /// Copied one register at a time, also within structures. g++ would copy structures by halves of a wide
  /// register where it compiles without wide registers, and loading both halves as one right after would
  /// stall.
  [[gnu::always_inline]] Lanes(const Lanes& from) { *this = from; }
  [[gnu::always_inline]] Lanes& operator=(const Lanes& from) {
    for (int k = 0; k < kParts; ++k) part[k] = from.part[k];
    return *this;
  }
  /// Puts the same number into all lanes.
  [[gnu::always_inline]] Lanes(Real value) {
    for (int k = 0; k < kParts; ++k) part[k] = value - Part{};
  }
  [[gnu::always_inline]] static Lanes load(const Real* from) {
    Lanes out;
    const auto* parts = reinterpret_cast<const typename Registers::Unaligned*>(from);
    for (int k = 0; k < kParts; ++k) out.part[k] = parts[k].part;
    return out;
  }
  /// Collects `number(0)` to `number(kCount - 1)`.
  template <class Each>
  [[gnu::always_inline]] static Lanes of(const Each& number) {
    return collect(number, std::make_integer_sequence<int, kCount / kParts>());
  }
  [[gnu::always_inline]] void store(Real* to) const {
    auto* parts = reinterpret_cast<typename Registers::Unaligned*>(to);
    for (int k = 0; k < kParts; ++k) parts[k].part = part[k];
  }
  /// Address must be a multiple of 16 bytes.
  [[gnu::always_inline]] static Lanes load_aligned(const Real* from) {
    return load(std::assume_aligned<16>(from));
  }
  [[gnu::always_inline]] void store_aligned(Real* to) const { store(std::assume_aligned<16>(to)); }

  [[gnu::always_inline]] friend Lanes operator+(const Lanes& a, const Lanes& b) {
    Lanes out;
    for (int k = 0; k < kParts; ++k) out.part[k] = a.part[k] + b.part[k];
    return out;
  }
  [[gnu::always_inline]] friend Lanes operator-(const Lanes& a, const Lanes& b) {
    Lanes out;
    for (int k = 0; k < kParts; ++k) out.part[k] = a.part[k] - b.part[k];
    return out;
  }
  [[gnu::always_inline]] friend Lanes operator*(const Lanes& a, const Lanes& b) {
    Lanes out;
    for (int k = 0; k < kParts; ++k) out.part[k] = a.part[k] * b.part[k];
    return out;
  }
  [[gnu::always_inline]] friend Lanes operator/(const Lanes& a, const Lanes& b) {
    Lanes out;
    for (int k = 0; k < kParts; ++k) out.part[k] = a.part[k] / b.part[k];
    return out;
  }
  [[gnu::always_inline]] friend Lanes operator-(const Lanes& a) {
    Lanes out;
    for (int k = 0; k < kParts; ++k) out.part[k] = -a.part[k];
    return out;
  }
  [[gnu::always_inline]] Lanes& operator+=(const Lanes& b) { return *this = *this + b; }
  [[gnu::always_inline]] Lanes& operator-=(const Lanes& b) { return *this = *this - b; }
  [[gnu::always_inline]] Lanes& operator*=(const Lanes& b) { return *this = *this * b; }

  [[gnu::always_inline]] friend Mask operator<(const Lanes& a, const Lanes& b) {
    Mask out;
    for (int k = 0; k < kParts; ++k) out.part[k] = a.part[k] < b.part[k];
    return out;
  }
  [[gnu::always_inline]] friend Mask operator>(const Lanes& a, const Lanes& b) { return b < a; }
  /// Returns `yes` where the mask is set, `no` elsewhere.
  [[gnu::always_inline]] friend Lanes select(const Mask& mask, const Lanes& yes, const Lanes& no) {
    Lanes out;
    for (int k = 0; k < kParts; ++k) out.part[k] = mask.part[k] ? yes.part[k] : no.part[k];
    return out;
  }
  /// Returns the first of equals, as std::min and std::max do, and the first if one is NaN.
  [[gnu::always_inline]] friend Lanes min(const Lanes& a, const Lanes& b) {
    Lanes out;
    for (int k = 0; k < kParts; ++k) out.part[k] = b.part[k] < a.part[k] ? b.part[k] : a.part[k];
    return out;
  }
  [[gnu::always_inline]] friend Lanes max(const Lanes& a, const Lanes& b) {
    Lanes out;
    for (int k = 0; k < kParts; ++k) out.part[k] = a.part[k] < b.part[k] ? b.part[k] : a.part[k];
    return out;
  }
  [[gnu::always_inline]] friend Lanes sqrt(const Lanes& a) {
    Real lane[kCount];
    a.store(lane);
    return of([&](int i) __attribute__((always_inline)) { return std::sqrt(lane[i]); });
  }

 private:
  template <class Each, int... kWithin>
  [[gnu::always_inline]] static Lanes collect(const Each& number, std::integer_sequence<int, kWithin...>) {
    Lanes out;
    for (int k = 0; k < kParts; ++k) out.part[k] = Part{number(k * (kCount / kParts) + kWithin)...};
    return out;
  }
};

/// The scalar type: of Lanes, that of one lane; otherwise the number's own.
template <class Number>
struct ScalarOf {
  using Type = Number;
};
template <class Real, int kCount, int kBytes>
struct ScalarOf<Lanes<Real, kCount, kBytes>> {
  using Type = Real;
};
template <class Number>
using Scalar = typename ScalarOf<Number>::Type;
template <class Number>
inline constexpr bool kIsLanes = !std::is_same_v<Number, Scalar<Number>>;

/// Returns true if the mask is set in any lane.
template <class Real, int kCount, int kBytes>
[[gnu::always_inline]] inline bool any(const LaneMask<Real, kCount, kBytes>& mask) {
#ifdef PLUMB_VECTORS
  using Words = typename Register<Real, kBytes>::Words;
  Words all = reinterpret_cast<Words>(mask.part[0]);
  for (int k = 1; k < mask.kParts; ++k) all |= reinterpret_cast<Words>(mask.part[k]);
  long long word = all[0];
  for (int i = 1; i < static_cast<int>(kBytes / sizeof(word)); ++i) word |= all[i];
  return word != 0;
#else
  for (const bool set : mask.part)
    if (set) return true;
  return false;
#endif
}

/// Returns true if the mask is set in all lanes.
template <class Real, int kCount, int kBytes>
[[gnu::always_inline]] inline bool all(const LaneMask<Real, kCount, kBytes>& mask) {
#ifdef PLUMB_VECTORS
  using Words = typename Register<Real, kBytes>::Words;
  Words set = reinterpret_cast<Words>(mask.part[0]);
  for (int k = 1; k < mask.kParts; ++k) set &= reinterpret_cast<Words>(mask.part[k]);
  long long word = set[0];
  for (int i = 1; i < static_cast<int>(kBytes / sizeof(word)); ++i) word &= set[i];
  return word == -1;
#else
  for (const bool set : mask.part)
    if (!set) return false;
  return true;
#endif
}

// Does the same for single numbers, so that one algorithm serves both.
[[gnu::always_inline]] constexpr bool any(bool mask) { return mask; }
[[gnu::always_inline]] constexpr bool all(bool mask) { return mask; }
template <class Real>
[[gnu::always_inline]] constexpr Real select(bool mask, Real yes, Real no) {
  return mask ? yes : no;
}
/// Returns `yes()` where the mask is set, `no()` elsewhere. For single numbers only one of them is called.
template <class Yes, class No>
[[gnu::always_inline]] inline auto choose(bool mask, const Yes& yes, const No& no) {
  return mask ? yes() : no();
}
template <class Real, int kCount, int kBytes, class Yes, class No>
[[gnu::always_inline]] inline auto choose(const LaneMask<Real, kCount, kBytes>& mask, const Yes& yes,
                                          const No& no) {
  return select(mask, yes(), no());
}

}  // namespace plumb
