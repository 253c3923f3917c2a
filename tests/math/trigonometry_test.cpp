#include "engine/math/trigonometry.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

namespace plumb {
namespace {

/// Distance of `value` from `truth` in units of the last place of a `Real` at `truth`.
template <class Real>
double ulps(Real value, long double truth) {
  const Real near = static_cast<Real>(std::fabs(truth));
  const Real ulp = std::nextafter(near, std::numeric_limits<Real>::infinity()) - near;
  return static_cast<double>(std::fabs(static_cast<long double>(value) - truth) /
                             static_cast<long double>(ulp));
}

template <class Real>
double worst_ulps(Real angle) {
  const Rotation<Real> q = rotation_of(angle);
  return std::max(ulps(q.c, std::cos(static_cast<long double>(angle))),
                  ulps(q.s, std::sin(static_cast<long double>(angle))));
}

// Truth: the C library's 80-bit functions, 11 bits finer than a double. Their reduction is exact at any size.
template <class Real>
double worst_in(Real low, Real high, int points) {
  double worst = 0;
  for (int i = 0; i <= points; ++i) {
    const Real angle = low + (high - low) * (static_cast<Real>(i) / static_cast<Real>(points));
    worst = std::max({worst, worst_ulps(angle), worst_ulps(-angle)});
  }
  return worst;
}

TEST(Trigonometry, DoubleIsWithinOneUlpInOneTurn) { EXPECT_LT(worst_in(0.0, 3.2, 200000), 0.8); }
TEST(Trigonometry, FloatIsRoundedOnce) { EXPECT_LT(worst_in(0.0f, 3.2f, 200000), 0.51); }

TEST(Trigonometry, DoubleIsWithinOneUlpAtLargeAngles) {
  EXPECT_LT(worst_in(3.0, 1000.0, 100000), 0.8);
  EXPECT_LT(worst_in(1e3, 1.1e6, 100000), 0.8);  // crosses from one reduction to the other
  EXPECT_LT(worst_in(1e6, 1e15, 100000), 0.8);
}

TEST(Trigonometry, EveryMagnitudeFromTinyToHuge) {
  for (int exponent = -1070; exponent <= 1023; ++exponent) {
    for (double mantissa : {1.0, 1.2345678901234567, 1.75, 1.9999999999999998}) {
      const double angle = std::ldexp(mantissa, exponent);
      EXPECT_LT(worst_ulps(angle), 1.0) << angle;
    }
  }
}

// Multiples of pi/2 and the double that comes closest to one (Muller, Elementary Functions, 2006, ch. 11):
// what is left of the angle there is all cancellation.
TEST(Trigonometry, NearMultiplesOfAQuarterTurn) {
  for (int n = 1; n < 100000; n += 7) EXPECT_LT(worst_ulps(n * 1.5707963267948966), 0.8) << n;
  EXPECT_LT(worst_ulps(0x1.6ac5b262ca1ffp+849), 0.8);
  EXPECT_DOUBLE_EQ(rotation_of(3.14159265358979323846).s, 1.2246467991473532e-16);
}

TEST(Trigonometry, ZeroIsTheIdentity) {
  EXPECT_EQ(rotation_of(0.0).c, 1);
  EXPECT_EQ(rotation_of(0.0).s, 0);
}

TEST(Trigonometry, OppositeAnglesMirror) {
  for (double angle : {0.3, 2.0, 1e5, 3e7, 1e200}) {
    EXPECT_EQ(rotation_of(-angle).c, rotation_of(angle).c);
    EXPECT_EQ(rotation_of(-angle).s, -rotation_of(angle).s);
  }
}

TEST(Trigonometry, WhatIsNotFiniteGivesNaN) {
  for (double angle : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    EXPECT_TRUE(std::isnan(rotation_of(angle).c));
    EXPECT_TRUE(std::isnan(rotation_of(-angle).s));
    EXPECT_TRUE(std::isnan(rotation_of(static_cast<float>(angle)).s));
  }
}

// Bits recorded once; another compiler or optimisation level must not change them.
TEST(Trigonometry, SameBitsEverywhere) {
  std::uint64_t hash = 0xcbf29ce484222325ull;
  const auto mix = [&hash](double value) {
    std::uint64_t bits;
    std::memcpy(&bits, &value, sizeof bits);
    hash = (hash ^ bits) * 0x100000001b3ull;
  };
  for (int i = -5000; i < 5000; ++i) {
    const Rotation<double> q = rotation_of(i * 0.7310585786300049 * (1 + i * i));
    mix(q.c), mix(q.s);
  }
  EXPECT_EQ(hash, 1237617783380813095ull);
}

}  // namespace
}  // namespace plumb
