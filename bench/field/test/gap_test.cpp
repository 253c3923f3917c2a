#include "bench/field/gap.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

namespace plumb::field {
namespace {

constexpr double kRounding = 1e-14;  // m, for shapes of about 1 m

double gap_of(const Geometry& a, const BodyState& at_a, const Geometry& b, const BodyState& at_b) {
  const double forth = gap(place(a, at_a), place(b, at_b)), back = gap(place(b, at_b), place(a, at_a));
  EXPECT_NEAR(forth, back, kRounding);
  return forth;
}

BodyState at(double x, double y, double angle = 0) { return {.position = {x, y}, .angle = angle}; }

TEST(Gap, CirclesApartAndOverlapping) {
  const Circle circle{{}, 0.5};
  EXPECT_NEAR(gap_of(circle, at(0, 0), circle, at(3, 4)), 4, kRounding);
  EXPECT_NEAR(gap_of(circle, at(0, 0), circle, at(0.3, 0.4)), -0.5, kRounding);
  EXPECT_NEAR(gap_of(circle, at(1, 1), circle, at(1, 1)), -1, kRounding);
}

TEST(Gap, BoxesSideBySideTouch) {
  EXPECT_NEAR(gap_of(box(0.5, 0.5), at(0, 0.5), box(0.5, 0.5), at(1, 0.5)), 0, kRounding);
  EXPECT_NEAR(gap_of(box(0.5, 0.5), at(0, 0), box(0.5, 0.5), at(0.25, 0.99)), -0.01, kRounding);
}

TEST(Gap, CornersOfBoxesLookAtEachOther) {
  EXPECT_NEAR(gap_of(box(0.5, 0.5), at(0, 0), box(0.5, 0.5), at(1.3, 1.4)), 0.5, kRounding);
}

TEST(Gap, BoxOnItsCornerStandsInABox) {
  const double lift = std::numbers::sqrt2 / 2 - 0.1;
  EXPECT_NEAR(gap_of(box(5, 1), at(0, -1), box(0.5, 0.5), at(0, lift, std::numbers::pi / 4)), -0.1,
              kRounding);
}

TEST(Gap, OneBoxInsideAnotherLeavesByTheNearestSide) {
  EXPECT_NEAR(gap_of(box(2, 1), at(0, 0), box(0.1, 0.1), at(0.5, 0.2)), -(1 - 0.2 + 0.1), kRounding);
}

TEST(Gap, CapsuleAcrossABoxAndBesideIt) {
  const Capsule capsule{{-1, 0}, {1, 0}, 0.25};
  EXPECT_NEAR(gap_of(capsule, at(0, 0.75), box(0.5, 0.5), at(0, 0)), 0, kRounding);
  EXPECT_NEAR(gap_of(capsule, at(0, 0.45), box(0.5, 0.5), at(0, 0)), -0.3, kRounding);
  EXPECT_NEAR(gap_of(capsule, at(1.8, 0), box(0.5, 0.5), at(0, 0)), 0.05, kRounding);
}

TEST(Gap, RoundingGrowsAPolygon) {
  EXPECT_NEAR(gap_of(box(0.5, 0.5, {}, 0.1), at(0, 0), Circle{{}, 0.2}, at(0.8, 0.9)), 0.2, kRounding);
}

TEST(Gap, SegmentsCrossTouchAndRunAlongALine) {
  const Segment level{{-1, 0}, {1, 0}};
  EXPECT_NEAR(gap_of(level, at(0, 0), level, at(0, 0, std::numbers::pi / 2)), -1, kRounding);
  EXPECT_NEAR(gap_of(level, at(0, 0), level, at(0.5, 0)), 0, kRounding);
  EXPECT_NEAR(gap_of(level, at(0, 0), level, at(3, 0)), 1, kRounding);
  EXPECT_NEAR(gap_of(level, at(0, 0), Circle{{}, 0.1}, at(1.5, 0)), 0.4, kRounding);
  EXPECT_NEAR(gap_of(level, at(0, 0), Circle{{}, 0.1}, at(0.5, 0)), -0.1, kRounding);
}

// Returns the signed gap of convex sets as the largest separation over all directions (Boyd, Vandenberghe
// 2004, 8.2). Tries many directions, then refines around the best.
long double gap_by_directions(const PlacedShape& a, const PlacedShape& b) {
  const auto separation = [&](long double angle) {
    const long double x = std::cos(angle), y = std::sin(angle);
    long double most = -1e9L, least = 1e9L;
    for (const Vec2d p : a.core) most = std::max(most, x * p.x + y * p.y);
    for (const Vec2d p : b.core) least = std::min(least, x * p.x + y * p.y);
    return least - b.radius - most - a.radius;
  };
  long double best = -1e9L, where = 0;
  long double width = 2 * std::numbers::pi_v<long double> / 2000;
  for (int i = 0; i < 2000; ++i)
    if (const long double s = separation(i * width); s > best) best = s, where = i * width;
  while (width > 1e-17L) {
    const long double middle = where;
    for (int i = -10; i <= 10; ++i)
      if (const long double s = separation(middle + i * width / 10); s > best)
        best = s, where = middle + i * width / 10;
    width /= 5;
  }
  return best;
}

TEST(Gap, AgreesWithTheLargestSeparationOverAllDirections) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> place_at(-1, 1), turn(-4, 4);
  const std::vector<Geometry> shapes{Circle{{0.1, 0}, 0.3},
                                     Capsule{{-0.4, 0}, {0.3, 0.1}, 0.2},
                                     box(0.6, 0.2),
                                     Polygon{{{-1, 0}, {0.5, 1}, {0, 2}}, 0},
                                     Polygon{{{-0.3, -0.4}, {0.4, -0.4}, {0.5, 0.1}, {0, 0.5}}, 0.15},
                                     Segment{{-0.5, 0.2}, {0.6, 0}}};
  int overlapping = 0;
  for (int trial = 0; trial < 600; ++trial) {
    const Geometry &first = shapes[trial % 6], &second = shapes[trial / 6 % 6];
    const PlacedShape a = place(first, at(place_at(random), place_at(random), turn(random)));
    const PlacedShape b = place(second, at(place_at(random), place_at(random), turn(random)));
    const double measured = gap(a, b);
    overlapping += measured < 0;
    EXPECT_NEAR(measured, static_cast<double>(gap_by_directions(a, b)), 3e-12) << "trial " << trial;
  }
  EXPECT_GT(overlapping, 100);
  EXPECT_LT(overlapping, 500);
}

}  // namespace
}  // namespace plumb::field
