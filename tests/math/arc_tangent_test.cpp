#include "engine/math/arc_tangent.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>

namespace plumb {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Error in units of the last place. Truth: the C library's 80-bit function, 11 bits finer than a double.
double ulps(double y, double x) {
  const long double truth = std::atan2(static_cast<long double>(y), static_cast<long double>(x));
  const double near = static_cast<double>(std::fabs(truth));
  const double ulp = std::nextafter(near, kInfinity) - near;
  return static_cast<double>(std::fabs(arc_tangent(y, x) - truth)) / ulp;
}

TEST(ArcTangent, IsWithinOneUlpInAllQuadrants) {
  std::mt19937_64 bits(1);
  const auto number = [&bits] { return static_cast<double>(bits() >> 11) * 0x1p-52 - 1; };
  double worst = 0;
  for (int i = 0; i < 300000; ++i) {
    const double y = number(), x = number();
    worst = std::max({worst, ulps(y, x), ulps(0x1p-20 * y, x), ulps(y, 0x1p-20 * x)});
  }
  EXPECT_LT(worst, 1.0);
}

// The table's nodes k/8 and the places half-way between them, where one entry takes over from the next.
TEST(ArcTangent, IsWithinOneUlpAroundTheTable) {
  for (int k = -64; k <= 64; ++k)
    for (int step = -200; step <= 200; ++step) {
      const double y = k / 16.0 + step * 1e-16;
      EXPECT_LT(ulps(y, 1), 1.0) << y;
      EXPECT_LT(ulps(y, -3.7), 1.0) << y;
    }
}

TEST(ArcTangent, EveryMagnitude) {
  for (int exponent = -1070; exponent <= 1023; ++exponent)
    for (double mantissa : {1.0, 1.2345678901234567, 1.9999999999999998}) {
      const double size = std::ldexp(mantissa, exponent);
      EXPECT_LT(ulps(size, 0.75 * size), exponent > -1000 ? 1.0 : 1.1) << size;
      EXPECT_LT(ulps(-0.01 * size, size), exponent > -1000 ? 1.0 : 1.1) << size;
      EXPECT_LT(ulps(size, 1), 1.0) << size;
      EXPECT_LT(ulps(1, -size), 1.0) << size;
    }
}

TEST(ArcTangent, ZerosAndInfinitiesAreThoseOfC) {
  for (const double y : {0.0, -0.0, 1.0, -1.0, kInfinity, -kInfinity, 5e-324, -1e308})
    for (const double x : {0.0, -0.0, 1.0, -1.0, kInfinity, -kInfinity, 5e-324, -1e308}) {
      const double expected = std::atan2(y, x);
      EXPECT_EQ(arc_tangent(y, x), expected) << y << ' ' << x;
      EXPECT_EQ(std::signbit(arc_tangent(y, x)), std::signbit(expected)) << y << ' ' << x;
    }
  EXPECT_TRUE(std::isnan(arc_tangent(std::nan(""), 1)));
  EXPECT_TRUE(std::isnan(arc_tangent(1, std::nan(""))));
}

TEST(ArcTangent, SymmetriesHoldToTheBit) {
  std::mt19937_64 bits(2);
  for (int i = 0; i < 10000; ++i) {
    const double y = static_cast<double>(bits() >> 11), x = static_cast<double>(bits() >> 11);
    EXPECT_EQ(arc_tangent(-y, x), -arc_tangent(y, x));
    EXPECT_EQ(arc_tangent(4 * y, 4 * x), arc_tangent(y, x));
  }
}

}  // namespace
}  // namespace plumb
