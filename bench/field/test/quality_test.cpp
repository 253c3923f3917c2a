#include "bench/field/quality.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "bench/field/test/still_world.h"

namespace plumb::field {
namespace {

constexpr double kRounding = 1e-14;

struct Bench {
  StillWorld world;
  Builder builder{world};

  Quality quality() const { return measure_quality(builder.inventory(), builder.states()); }
};

const ShapeDefinition kSquare{.geometry = box(0.5, 0.5)};

TEST(MeasureQuality, DepthsOfAStack) {
  Bench bench;
  bench.builder.create_body({.type = BodyType::Static, .position = {0, -1}}, {.geometry = box(10, 1)});
  bench.builder.create_body({.position = {0, 0.499}}, kSquare);    // 1 mm in the ground
  bench.builder.create_body({.position = {0.2, 1.496}}, kSquare);  // 3 mm in the first
  bench.builder.create_body({.position = {0, 2.511}}, kSquare);    // 15 mm above the second
  bench.builder.create_body({.position = {0, 3.536}}, kSquare);    // 25 mm above the third: not a neighbour
  const Quality quality = bench.quality();
  EXPECT_TRUE(quality.finite);
  EXPECT_EQ(quality.near, 3);
  EXPECT_EQ(quality.overlapping, 2);
  EXPECT_NEAR(quality.deepest, 0.003, kRounding);
  EXPECT_NEAR(quality.mean_depth, 0.002, kRounding);
}

TEST(MeasureQuality, PairsThatMayNotTouchDoNotCount) {
  Bench bench;
  ShapeDefinition grouped = kSquare, masked = kSquare;
  grouped.group = 3;
  masked.category = 2;
  masked.mask = 1;
  bench.builder.create_body({.position = {0, 0}}, grouped);
  bench.builder.create_body({.position = {0, 0}}, grouped);
  bench.builder.create_body({.position = {5, 0}}, masked);
  bench.builder.create_body({.position = {5, 0}}, masked);
  bench.builder.create_body({.type = BodyType::Static, .position = {9, 0}}, kSquare);
  bench.builder.create_body({.type = BodyType::Kinematic, .position = {9, 0}}, kSquare);
  bench.builder.create_body({.position = {13, 0}}, {kSquare, kSquare});
  EXPECT_EQ(bench.quality().overlapping, 0);
  bench.builder.create_body({.position = {5.9, 0}}, kSquare);
  EXPECT_EQ(bench.quality().overlapping, 2);
}

TEST(MeasureQuality, JointsHideTheirPairAndShowTheirGap) {
  Bench bench;
  const int a = bench.builder.create_body({.position = {0, 0}}, kSquare);
  const int b = bench.builder.create_body({.position = {0.9, 0}, .angle = 0.3}, kSquare);
  // Anchors at (0.5, 0) and 0.2 m below b's centre along its own axis.
  RevoluteDefinition joint{.anchor_a = {0.5, 0}, .anchor_b = {-0.4, 0}, .limits = Limits{-0.1, 0.2}};
  bench.builder.create_revolute(a, b, joint);
  Quality quality = bench.quality();
  EXPECT_EQ(quality.overlapping, 0);
  const double expected = std::hypot(0.4 * (1 - std::cos(0.3)), 0.4 * std::sin(0.3));
  EXPECT_NEAR(quality.worst_joint, expected, kRounding);
  EXPECT_NEAR(quality.mean_joint, expected, kRounding);
  EXPECT_NEAR(quality.worst_limit, 0.1, kRounding);
  bench.builder.create_body({.position = {0, 0.95}}, kSquare);
  EXPECT_GT(bench.quality().overlapping, 0);
  bench.builder.destroy_body(b);
  quality = bench.quality();
  EXPECT_EQ(quality.worst_joint, 0);
  EXPECT_EQ(quality.overlapping, 1);
  EXPECT_NEAR(quality.deepest, 0.05, kRounding);
}

TEST(MeasureQuality, EnergyOfMotionAndSpin) {
  Bench bench;
  bench.builder.create_body({.velocity = {3, 4}, .spin = 6}, {.geometry = box(0.5, 0.5), .density = 2});
  bench.builder.create_body({.type = BodyType::Kinematic, .position = {9, 9}, .velocity = {100, 0}}, kSquare);
  EXPECT_NEAR(bench.quality().kinetic_energy, 2 * 25.0 / 2 + 2.0 / 6 * 36 / 2, 1e-13);
}

TEST(MeasureQuality, SeesWhatIsNotFinite) {
  Bench bench;
  bench.builder.create_body({.velocity = {std::numeric_limits<double>::quiet_NaN(), 0}}, kSquare);
  EXPECT_FALSE(bench.quality().finite);
  bench.builder.destroy_body(0);
  EXPECT_TRUE(bench.quality().finite);
}

TEST(MeasureSpeed, IsThatOfTheCentreOfMass) {
  Bench bench;
  // The frame's origin stays; the centre, 1 m from it, moves on a circle.
  bench.builder.create_body({}, {.geometry = box(0.5, 0.5, {1, 0})});
  bench.builder.create_body({.position = {9, 0}}, kSquare);
  bench.builder.create_body({.type = BodyType::Kinematic, .position = {20, 0}}, kSquare);
  const std::vector<BodyState> before = bench.builder.states();
  std::vector<BodyState> after = before;
  after[0].angle = 0.02;
  after[2].position = {30, 0};
  const Speed speed = measure_speed(bench.builder.inventory(), before, after, 0.1);
  EXPECT_NEAR(speed.max, 2 * std::sin(0.01) / 0.1, 1e-13);
  EXPECT_NEAR(speed.rms, speed.max / std::sqrt(2.0), 1e-13);
}

}  // namespace
}  // namespace plumb::field
