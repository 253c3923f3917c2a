#include "engine/math/rotations.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace plumb {
namespace {

struct Turned {
  std::vector<double> c, s;
};

Turned turned(const std::vector<double>& angles) {
  Turned out{std::vector<double>(angles.size()), std::vector<double>(angles.size())};
  rotations_of(angles, out.c, out.s);
  return out;
}

// Truth: the C library's 80-bit functions, 11 bits finer than a double.
double worst_in(double low, double high, std::size_t points) {
  std::vector<double> angles;
  for (std::size_t i = 0; i < points; ++i) {
    angles.push_back(low + (high - low) * (static_cast<double>(i) / static_cast<double>(points)));
    angles.push_back(-angles.back());
  }
  const Turned found = turned(angles);
  double worst = 0;
  for (std::size_t i = 0; i < angles.size(); ++i) {
    const long double angle = angles[i];
    worst = std::max({worst, static_cast<double>(std::abs(found.c[i] - std::cos(angle))),
                      static_cast<double>(std::abs(found.s[i] - std::sin(angle)))});
  }
  return worst;
}

TEST(Rotations, AreRightToARounding) {
  EXPECT_LT(worst_in(0, 1e-3, 1001), 2e-16);
  EXPECT_LT(worst_in(0, 7, 100001), 4e-16);
  EXPECT_LT(worst_in(7, 1e4, 100001), 4e-16);
  EXPECT_LT(worst_in(1e4, 0x1p20, 100001), 4e-16);
  EXPECT_LT(worst_in(0x1p20, 1e12, 1001), 4e-16);
}

TEST(Rotations, AnAngleHasTheSameBitsBesideAnyOthers) {
  const std::vector<double> angles = {0.3, -2, 1.57, 4, 100, -0.0, 3.14159, 1e-9, -77};
  const Turned together = turned(angles);
  for (std::size_t i = 0; i < angles.size(); ++i) {
    const Turned alone = turned({angles[i]});
    EXPECT_EQ(together.c[i], alone.c[0]) << angles[i];
    EXPECT_EQ(together.s[i], alone.s[0]) << angles[i];
  }
}

TEST(Rotations, WhatIsFarOrNotFiniteDoesNotSpoilItsNeighbours) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double other : {nan, -std::numeric_limits<double>::infinity(), 1e300}) {
    const Turned found = turned({0.5, other, -0.5, 2, 1});
    EXPECT_NEAR(found.c[0], std::cos(0.5), 4e-16);
    EXPECT_NEAR(found.s[4], std::sin(1.0), 4e-16);
    EXPECT_EQ(std::isfinite(found.c[1]), other == 1e300);
    EXPECT_EQ(std::isfinite(found.s[1]), other == 1e300);
  }
}

// FNV-1a over the bits of 10,000 pairs: the same with every compiler and level of optimisation.
TEST(Rotations, HaveTheSameBitsEverywhere) {
  std::vector<double> angles;
  for (int i = 0; i < 10000; ++i) angles.push_back((i - 5000) * 0.0123456789);
  const Turned found = turned(angles);
  std::uint64_t hash = 14695981039346656037u;
  for (const auto* numbers : {&found.c, &found.s}) {
    for (const double number : *numbers)
      hash = (hash ^ std::bit_cast<std::uint64_t>(number)) * 1099511628211u;
  }
  EXPECT_EQ(hash, 17796518237019985924u);
}

}  // namespace
}  // namespace plumb
