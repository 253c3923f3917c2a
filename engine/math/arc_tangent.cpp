#include "engine/math/arc_tangent.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "engine/math/double_double.h"

namespace plumb {
namespace {

constexpr DoubleDouble kPi = {0x1.921fb54442d18p+1, 0x1.1a62633145c07p-53};
constexpr DoubleDouble kHalfPi = {0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54};

/// atan(k / 8)
constexpr DoubleDouble kArcs[9] = {{0, 0},
                                   {0x1.fd5ba9aac2f6ep-4, -0x1.cd37686760c17p-59},
                                   {0x1.f5b75f92c80ddp-3, 0x1.8ab6e3cf7afbdp-57},
                                   {0x1.6f61941e4def1p-2, -0x1.c63aae6f6e918p-56},
                                   {0x1.dac670561bb4fp-2, 0x1.a2b7f222f65e2p-56},
                                   {0x1.1e00babdefeb4p-1, -0x1.928df287a668fp-58},
                                   {0x1.4978fa3269ee1p-1, 0x1.2419a87f2a458p-56},
                                   {0x1.700a7c5784634p-1, -0x1.8c34d25aadef6p-56},
                                   {0x1.921fb54442d18p-1, 0x1.1a62633145c07p-55}};

/// Returns a / b minus its rounded value q, from halves of 26 bits (Veltkamp, Dekker).
double quotient_tail(double a, double b, double q) {
  constexpr double kSplit = 0x1p27 + 1;
  const double b_high = kSplit * b - (kSplit * b - b), b_low = b - b_high;
  const double q_high = kSplit * q - (kSplit * q - q), q_low = q - q_high;
  return ((((a - q_high * b_high) - q_high * b_low) - q_low * b_high) - q_low * b_low) / b;
}

/// atan(y / x) for 0 <= y <= x, x normal. With the nearest k/8 to y/x,
/// atan(y/x) = atan(k/8) + atan(r), r = (y - x k/8) / (x + y k/8), |r| < 1/15.
DoubleDouble first_octant(double y, double x) {
  // Adds slightly less than a half (0.4999), so that y >= x k/16 and the difference below has no rounding
  // (Sterbenz).
  const int k = static_cast<int>(8 * (y / x) + 0.4999);
  const double ratio = 0.125 * k;
  // x k/8 in two parts without rounding: the upper part has 8 bits to spare.
  const double upper = std::bit_cast<double>(std::bit_cast<std::uint64_t>(x) & ~std::uint64_t{0xFF});
  const double lower = x - upper;
  const double over = (y - ratio * upper) - ratio * lower, under = x + ratio * y;
  const double r = over / under;
  const double under_tail = (x - under) + ratio * y;
  // The series of the arc tangent; the first term left out is below 1e-20 of r.
  const double z = r * r;
  constexpr double k3 = -1.0 / 3, k5 = 1.0 / 5, k7 = -1.0 / 7, k9 = 1.0 / 9, k11 = -1.0 / 11, k13 = 1.0 / 13;
  const double series = z * (k3 + z * (k5 + z * (k7 + z * (k9 + z * (k11 + z * k13)))));
  const DoubleDouble arc = kArcs[k];
  const double small = r * series + ((quotient_tail(over, under, r) - r * under_tail / under) + arc.tail);
  const double rest = r + small;
  const double sum = arc.value + rest;
  // Add the rounding errors of both sums: they determine the last digit once a quarter turn is added.
  return {sum, ((arc.value - sum) + rest) + ((r - rest) + small)};
}

/// Returns the arc tangent of y / x for positive finite y and x.
DoubleDouble first_quadrant(double y, double x) {
  const bool steep = y > x;
  double adjacent = steep ? y : x, opposite = steep ? x : y;
  // Sums must not overflow and quotients must not underflow: scaling by powers of two is exact.
  if (adjacent > 0x1p900) {
    adjacent *= 0x1p-200, opposite *= 0x1p-200;
  } else if (adjacent < 0x1p-900) {
    adjacent *= 0x1p100, opposite *= 0x1p100;
  }
  const DoubleDouble arc = first_octant(opposite, adjacent);
  if (!steep) return arc;
  const double angle = kHalfPi.value - arc.value;
  return {angle, ((kHalfPi.value - angle) - arc.value) + (kHalfPi.tail - arc.tail)};
}

}  // namespace

double arc_tangent(double y, double x) {
  if (std::isnan(x) || std::isnan(y)) return std::numeric_limits<double>::quiet_NaN();
  double height = std::fabs(y), width = std::fabs(x);
  if (std::isinf(height) || std::isinf(width)) {
    height = std::isinf(height) ? 1 : 0;
    width = std::isinf(width) ? 1 : 0;
  }
  const DoubleDouble arc = height == 0 && width == 0 ? DoubleDouble{} : first_quadrant(height, width);
  double angle = arc.value + arc.tail;
  if (std::signbit(x)) angle = (kPi.value - arc.value) + (kPi.tail - arc.tail);
  return std::signbit(y) ? -angle : angle;
}

}  // namespace plumb
