#include "engine/math/exponential.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace plumb {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// ln 2 in two parts: the first has 33 bits, so that its products with exponents are exact.
constexpr double kLn2High = 0x1.62e42fefp-1, kLn2Low = 0x1.473de6af278edp-34;

double power_of_two(int exponent) {
  return std::bit_cast<double>(static_cast<std::uint64_t>(exponent + 1023) << 52);
}

}  // namespace

// e^x = 2^k e^r with |r| <= ln 2 / 2, and e^r by its series: r^15/15! < 1e-19.
double exponential(double x) {
  if (std::isnan(x)) return x;
  if (x > 709.8) return kInfinity;
  if (x < -745.2) return 0;
  constexpr double kToInteger = 0x1.8p52;  // adding it rounds to the nearest integer
  const double k = (x * 0x1.71547652b82fep+0 + kToInteger) - kToInteger;
  const double high = x - k * kLn2High, low = -(k * kLn2Low), r = high + low;
  double tail = 0;  // e^r - 1 - r, over r^2
  for (int n = 15; n >= 3; --n) tail = (1 + tail) * r / n;
  const double grown = 1 + (high + (low + r * r * 0.5 * (1 + tail)));
  // Scales in two steps, so that the largest and the subnormal results are reached.
  const int half = static_cast<int>(k) / 2;
  return grown * power_of_two(half) * power_of_two(static_cast<int>(k) - half);
}

// x = 2^k m with m between sqrt(1/2) and sqrt 2; ln m = 2 artanh s with s = (m - 1)/(m + 1), |s| < 0.1716,
// and artanh by its series: s^23/23 < 1e-18.
double logarithm(double x) {
  if (std::isnan(x) || x < 0) return std::numeric_limits<double>::quiet_NaN();
  if (x == 0) return -kInfinity;
  if (x == kInfinity) return x;
  int k = 0;
  if (x < std::numeric_limits<double>::min()) x *= 0x1p54, k = -54;
  const std::uint64_t bits = std::bit_cast<std::uint64_t>(x);
  k += static_cast<int>(bits >> 52) - 1023;
  double m = std::bit_cast<double>((bits & 0xFFFFFFFFFFFFFull) | 0x3FF0000000000000ull);
  if (m > 0x1.6a09e667f3bcdp+0) m *= 0.5, ++k;
  const double f = m - 1, s = f / (2 + f), square = s * s;
  double sum = 0;  // artanh s = s + s^3/3 + ...: the terms from s^3/3 on, divided by s
  for (int n = 23; n >= 3; n -= 2) sum = square * (1.0 / n + sum);
  // 2 s = f - s f, so the leading term is exact.
  return k * kLn2High + (f - (s * f - (2 * s * sum + k * kLn2Low)));
}

double power(double base, double exponent) {
  constexpr double kMostFactors = 64;
  if (exponent == std::floor(exponent) && std::abs(exponent) <= kMostFactors) {
    double product = 1;
    for (int i = static_cast<int>(std::abs(exponent)); i > 0; --i) product *= base;
    return exponent < 0 ? 1 / product : product;
  }
  if (base < 0 && exponent == std::floor(exponent)) {
    const double size = exponential(exponent * logarithm(-base));
    return std::fmod(exponent, 2) == 0 ? size : -size;
  }
  if (base == 0) return exponent > 0 ? 0 : kInfinity;
  return exponential(exponent * logarithm(base));
}

}  // namespace plumb
