#include "engine/math/trigonometry.h"

#include <bit>
#include <cstdint>
#include <limits>

#include "engine/math/double_double.h"

namespace plumb {
namespace {

/// angle = quadrant pi/2 + rest, |rest| <= pi/4 (up to a rounding).
struct Reduced {
  DoubleDouble rest;
  unsigned quadrant = 0;
};

/// Returns a + b without error (Knuth).
DoubleDouble exact_sum(double a, double b) {
  const double sum = a + b;
  const double b_seen = sum - a;
  return {sum, (a - (sum - b_seen)) + (b - b_seen)};
}

/// Returns a b without error, from halves of 26 bits (Veltkamp, Dekker).
DoubleDouble exact_product(double a, double b) {
  constexpr double kSplit = 0x1p27 + 1;
  const double a_high = kSplit * a - (kSplit * a - a), a_low = a - a_high;
  const double b_high = kSplit * b - (kSplit * b - b), b_low = b - b_high;
  const double product = a * b;
  return {product, ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low};
}

// pi/2 in three parts of 33 bits and a remainder: a part times a quadrant number below 2^20 is exact.
constexpr double kHalfPiParts[3] = {0x1.921fb544p+0, 0x1.0b4611a6p-34, 0x1.3198a2ep-69};
constexpr double kHalfPiRest = 0x1.b839a252049c1p-104;
constexpr double kPartsLimit = 0x1p20;

/// Applies Cody and Waite's reduction, for |angle| <= kPartsLimit.
Reduced reduce_by_parts(double angle) {
  constexpr double kTwoOverPi = 0x1.45f306dc9c883p-1;
  constexpr double kToInteger = 0x1.8p52;  // adding it rounds to the nearest integer
  const double quadrants = (angle * kTwoOverPi + kToInteger) - kToInteger;
  const double first = angle - quadrants * kHalfPiParts[0];
  const DoubleDouble second = exact_sum(first, -quadrants * kHalfPiParts[1]);
  const DoubleDouble third = exact_sum(second.value, -quadrants * kHalfPiParts[2]);
  const double tail = (second.tail + third.tail) - quadrants * kHalfPiRest;
  return {exact_sum(third.value, tail), static_cast<unsigned>(static_cast<std::int64_t>(quadrants)) & 3u};
}

/// The first 1216 bits of 2/pi after the point.
constexpr std::uint32_t kTwoOverPiBits[38] = {
    0xA2F9836Eu, 0x4E441529u, 0xFC2757D1u, 0xF534DDC0u, 0xDB629599u, 0x3C439041u, 0xFE5163ABu, 0xDEBBC561u,
    0xB7246E3Au, 0x424DD2E0u, 0x06492EEAu, 0x09D1921Cu, 0xFE1DEB1Cu, 0xB129A73Eu, 0xE88235F5u, 0x2EBB4484u,
    0xE99C7026u, 0xB45F7E41u, 0x3991D639u, 0x835339F4u, 0x9C845F8Bu, 0xBDF9283Bu, 0x1FF897FFu, 0xDE05980Fu,
    0xEF2F118Bu, 0x5A0A6D1Fu, 0x6D367ECFu, 0x27CB09B7u, 0x4F463F66u, 0x9E5FEA2Du, 0x7527BAC7u, 0xEBE5F17Bu,
    0x3D0739F7u, 0x8A5292EAu, 0x6BFB5FB1u, 0x1F8D5D08u, 0x56033046u, 0xFC7B6BABu};

/// Returns the 32 bits of 2/pi that follow its first `start` bits; bits before the point are 0.
std::uint32_t two_over_pi_bits(int start) {
  const auto word = [](int i) { return i < 0 ? std::uint64_t{0} : std::uint64_t{kTwoOverPiBits[i]}; };
  const int first = start >= 0 ? start / 32 : -((31 - start) / 32);
  const int shift = start - 32 * first;
  return static_cast<std::uint32_t>((word(first) << 32 | word(first + 1)) >> (32 - shift));
}

/// Applies Payne and Hanek's reduction, for |angle| > kPartsLimit: multiplies by the bits of 2/pi that decide
/// the quadrant and by the 190 bits below them. Higher bits contribute only whole turns.
Reduced reduce_by_bits(double angle) {
  constexpr int kLimbs = 6;
  const std::uint64_t bits = std::bit_cast<std::uint64_t>(angle);
  const int exponent = static_cast<int>(bits >> 52 & 0x7FF) - 1075;  // |angle| = mantissa 2^exponent
  const std::uint64_t mantissa = (bits & 0xFFFFFFFFFFFFFull) | 1ull << 52;
  const std::uint64_t halves[2] = {mantissa & 0xFFFFFFFFu, mantissa >> 32};

  // product = mantissa 2/pi 2^exponent mod 4, as a fixed-point number with 2 bits before the point.
  std::uint32_t product[kLimbs] = {};  // least significant first
  for (int half = 0; half < 2; ++half) {
    std::uint64_t carry = 0;
    for (int i = 0; i + half < kLimbs; ++i) {
      const std::uint64_t factor = two_over_pi_bits(exponent - 2 + 32 * (kLimbs - 1 - i));
      const std::uint64_t sum = halves[half] * factor + product[i + half] + carry;
      product[i + half] = static_cast<std::uint32_t>(sum);
      carry = sum >> 32;
    }
  }

  unsigned quadrant = product[kLimbs - 1] >> 30;
  product[kLimbs - 1] &= 0x3FFFFFFFu;
  const bool above_half = (product[kLimbs - 1] & 0x20000000u) != 0;
  if (above_half) {  // the nearest quadrant is the next one: use the fraction minus 1
    quadrant = (quadrant + 1) & 3u;
    std::uint64_t carry = 1;
    for (int i = 0; i < kLimbs; ++i) {
      carry += static_cast<std::uint32_t>(~product[i]);
      product[i] = static_cast<std::uint32_t>(carry);
      carry >>= 32;
    }
    product[kLimbs - 1] &= 0x3FFFFFFFu;
  }

  DoubleDouble fraction;
  double weight = 0x1p-30;
  for (int i = kLimbs - 1; i >= 0; --i, weight *= 0x1p-32) {
    const DoubleDouble sum = exact_sum(fraction.value, product[i] * weight);
    fraction = exact_sum(sum.value, sum.tail + fraction.tail);
  }
  constexpr DoubleDouble kQuarterTurn = {0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54};
  const DoubleDouble main = exact_product(fraction.value, kQuarterTurn.value);
  const DoubleDouble rest = exact_sum(
      main.value, main.tail + (fraction.value * kQuarterTurn.tail + fraction.tail * kQuarterTurn.value));
  const double sign = above_half ? -1 : 1;
  if (angle < 0) return {{-sign * rest.value, -sign * rest.tail}, (0u - quadrant) & 3u};
  return {{sign * rest.value, sign * rest.tail}, quadrant};
}

/// Returns sin(x + tail) for |x| <= pi/4 by Taylor's series; the first term left out is below 1e-19.
double sine_of_rest(double x, double tail) {
  const double z = x * x;
  constexpr double k3 = -1.0 / 6, k5 = 1.0 / 120, k7 = -1.0 / 5040, k9 = 1.0 / 362880, k11 = -1.0 / 39916800,
                   k13 = 1.0 / 6227020800, k15 = -1.0 / 1307674368000, k17 = 1.0 / 355687428096000;
  const double series = k3 + z * (k5 + z * (k7 + z * (k9 + z * (k11 + z * (k13 + z * (k15 + z * k17))))));
  return x + (x * z * series + tail * (1 - 0.5 * z));
}

/// Returns cos(x + tail) for |x| <= pi/4 by Taylor's series; the first term left out is below 3e-18. The
/// rounding of 1 - x^2/2 is carried along.
double cosine_of_rest(double x, double tail) {
  const double z = x * x;
  constexpr double k4 = 1.0 / 24, k6 = -1.0 / 720, k8 = 1.0 / 40320, k10 = -1.0 / 3628800,
                   k12 = 1.0 / 479001600, k14 = -1.0 / 87178291200, k16 = 1.0 / 20922789888000;
  const double series = k4 + z * (k6 + z * (k8 + z * (k10 + z * (k12 + z * (k14 + z * k16)))));
  const double half = 0.5 * z;
  const double main = 1 - half;
  return main + (((1 - main) - half) + (z * z * series - x * tail));
}

}  // namespace

template <>
Rotation<double> rotation_of(double angle) {
  const double size = angle < 0 ? -angle : angle;
  if (!(size <= std::numeric_limits<double>::max())) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    return {nan, nan};
  }
  const auto [rest, quadrant] = size <= kPartsLimit ? reduce_by_parts(angle) : reduce_by_bits(angle);
  const double s = sine_of_rest(rest.value, rest.tail);
  const double c = cosine_of_rest(rest.value, rest.tail);
  switch (quadrant) {
    case 0:
      return {c, s};
    case 1:
      return {-s, c};
    case 2:
      return {-c, -s};
    default:
      return {s, -c};
  }
}

template <>
Rotation<float> rotation_of(float angle) {
  const Rotation<double> exact = rotation_of(static_cast<double>(angle));
  return {static_cast<float>(exact.c), static_cast<float>(exact.s)};
}

}  // namespace plumb
