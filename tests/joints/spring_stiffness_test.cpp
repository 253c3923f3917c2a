#include "engine/joints/spring_stiffness.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "engine/scene/error.h"

namespace plumb {
namespace {

constexpr PairMobility<double> kPair{0.5, 3, 2, 0.25};  // 2 kg and 1/3 kg m^2, 0.5 kg and 4 kg m^2

TEST(SpringStiffness, ReferenceIsThePoseOfOriginsWhateverTheCentresAre) {
  // Both frames turned and moved together, and centres of mass off the origins: the same reference.
  const Rotation<double> q{0.6, 0.8}, r{0.8, -0.6};
  const Vec2d centre_a{0.1, -0.2}, centre_b{0.3, 0.4}, offset{1.5, -2};
  const Rotation<double> b{q.c * r.c - q.s * r.s, q.s * r.c + q.c * r.s};
  const Vec2d origin{7, 8};
  const JointReference found =
      reference_of({origin + q * centre_a, q}, centre_a, {origin + q * offset + b * centre_b, b}, centre_b);
  EXPECT_NEAR(found.offset.x, offset.x, 1e-14);
  EXPECT_NEAR(found.offset.y, offset.y, 1e-14);
  EXPECT_NEAR(found.rotation.c, r.c, 1e-15);
  EXPECT_NEAR(found.rotation.s, r.s, 1e-15);
}

// A point's stiffness is the mean, over directions n, of the effective mass n K^-1 n.
TEST(SpringStiffness, OfAPointIsTheMeanOverDirections) {
  const Vec2d arm_a{0.7, 0.3}, arm_b{-0.2, 0.9};
  const MouseDefinition mouse{.anchor_b = arm_b};
  const WeldDefinition weld{
      .anchor_a = arm_a, .anchor_b = arm_b, .linear_spring = Spring{1, 0}, .angular_spring = Spring{1, 0}};
  const WeldDefinition stiff{.anchor_a = arm_a, .anchor_b = arm_b, .linear_spring = Spring{1, 0}};
  const double together = kPair.i_a * kPair.i_b / (kPair.i_a + kPair.i_b);
  const auto mean_of = [](double xx, double xy, double yy) {
    double sum = 0;
    constexpr int kDirections = 12;
    for (int i = 0; i < kDirections; ++i) {
      const double c = std::cos(2 * M_PI * i / kDirections), s = std::sin(2 * M_PI * i / kDirections);
      sum += (yy * c * c - 2 * xy * c * s + xx * s * s) / (xx * yy - xy * xy);
    }
    return sum / kDirections;
  };
  const auto outer = [](double i, Vec2d arm, double& xx, double& xy, double& yy) {
    xx += i * arm.y * arm.y, xy -= i * arm.x * arm.y, yy += i * arm.x * arm.x;
  };
  double xx = kPair.m_b, xy = 0, yy = kPair.m_b;
  outer(kPair.i_b, arm_b, xx, xy, yy);
  EXPECT_NEAR(1 / spring_mobility(mouse, {}, {}, {}, kPair).point, mean_of(xx, xy, yy), 1e-14);
  xx = yy = kPair.m_a + kPair.m_b, xy = 0;
  outer(kPair.i_a, arm_a, xx, xy, yy), outer(kPair.i_b, arm_b, xx, xy, yy);
  const JointReference closed{.offset = arm_a - arm_b};
  // Arms of a weld end at the middle of the gap, of which this one has none.
  EXPECT_NEAR(1 / spring_mobility(weld, closed, {}, {}, kPair).point, mean_of(xx, xy, yy), 1e-14);
  xx = yy = kPair.m_a + kPair.m_b, xy = 0;
  outer(together, arm_b - arm_a, xx, xy, yy);
  EXPECT_NEAR(1 / spring_mobility(stiff, closed, {}, {}, kPair).point, mean_of(xx, xy, yy), 1e-14);
}

TEST(SpringStiffness, OfWhatMovesNothingIsNone) {
  const JointKind coil = DistanceDefinition{.spring = Spring{3, 1}};
  const SpringMobility none = spring_mobility(coil, {}, {}, {}, {});
  EXPECT_EQ(none.axial, 0);
  EXPECT_EQ(joint_stiffness(coil, none).linear, 0);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(spring_constants(Spring{3, 1}, nan).stiffness, 0);
}

TEST(SpringStiffness, OfABodyThatOnlyTurnsIsThatOfTheDirectionInWhichItMoves) {
  // Locked in both directions: its point moves across the arm alone.
  const MouseDefinition mouse{.anchor_b = {0.5, 0}};
  EXPECT_NEAR(spring_mobility(mouse, {}, {}, {}, {0, 0, 0, 4}).point, 4 * 0.25, 1e-15);
}

TEST(SpringStiffness, JointsWithoutSpringsAreRefused) {
  try {
    joint_stiffness(GearDefinition{}, {});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::Unsupported);
    EXPECT_EQ(error.subject(), "gear joint");
    EXPECT_EQ(error.field(), "stiffness");
  }
}

}  // namespace
}  // namespace plumb
