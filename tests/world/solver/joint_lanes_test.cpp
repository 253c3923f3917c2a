#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "tests/world/solver/joint_bench.h"
#include "tests/world/vector_widths.h"

namespace plumb {
namespace {

struct Pair {
  double mass_a, inertia_a, mass_b, inertia_b;  // inverse
  bool held = false;
};

// Masses of each order, one hinge at a static body, one that another holds, and two bodies that only turn.
constexpr Pair kPairs[] = {{1, 2, 3, 4},       {1e-3, 2e-3, 5, 9}, {1, 1, 1, 1},  {0.5, 8, 2, 30},
                           {1, 6, 1, 6, true}, {7, 1, 1e3, 1e4},   {2, 2, 2, 3},  {0, 0, 1, 12},
                           {4, 9, 0.1, 0.3},   {1, 12, 1, 12},     {3, 5, 8, 13}, {0, 4, 0, 9},
                           {1, 1, 2, 2},       {1e4, 1e4, 1, 3},   {2, 24, 5, 60}};

/// Joints that are solved side by side. Hinges of all kinds: their rules at work and at rest, springs that
/// are solved as they are and ones that are too stiff for it, and how they answer at a body that many share.
template <class Real>
JointBench<Real> crowd(bool side_by_side) {
  JointBench<Real> bench;
  bench.gravity = {0, -10};
  bench.side_by_side = side_by_side;
  const auto joint = [](int number) {
    RevoluteDefinition hinge{.anchor_a = {0.4, 0.1 * (number % 7)}, .anchor_b = {-0.5, 0.2}};
    if (number % 4 == 1 || number % 3 == 2) hinge.limits = Range{-0.2 * (number % 5), 0.1};
    if (number % 4 == 2 || number % 3 == 2) hinge.motor = Motor{0.5 * (number % 3), 0.3};
    if (number % 4 == 3 || number % 3 == 2)
      hinge.spring = Spring{number % 8 == 7 ? 60.0 : 5.0, number % 8 == 3 ? 50 : 0.5};
    return hinge;
  };
  int number = 0;
  for (int round = 0; round < 8; ++round) {
    for (const Pair& pair : kPairs) {
      const bool plain = pair.held || pair.mass_a + pair.mass_b == 0;
      const RevoluteDefinition kind = plain ? RevoluteDefinition{} : joint(number);
      const double turned = 0.3 * (number % 15), further = turned + 0.05 * (number % 5);
      const Vec2d at{3.0 * number, 0.1 * number}, gap{0.01 * (number % 3), 0.02};
      const Vec2d to_b = rotation_of(turned) * kind.anchor_a - rotation_of(further) * kind.anchor_b + gap;
      const int a = bench.body(at, pair.mass_a, pair.inertia_a, turned);
      const int b = bench.body(at + to_b, pair.mass_b, pair.inertia_b, further);
      if (bench.dynamic(a)) bench.motion[a].velocity = {Real(0.7), Real(-0.2 * (number % 15))};
      bench.motion[b].angular_velocity = Real(1 + number % 15);
      const int made = bench.join(kind, a, b);
      if (pair.held) bench.joints.set_external(made);
      ++number;
    }
  }
  for (int i = 0; i < 60; ++i) {
    const Spring spring{i % 3 == 2 ? 60.0 : 4.0, 0.5};
    const int a = bench.body({2.0 * i, 50}, i % 7 == 6 ? 0 : 1, i % 7 == 6 ? 0 : 5);
    const int b = bench.body({2.0 * i + 1, 50.01}, 2, 7, 0.02 * i);
    const JointKind kinds[] = {
        DistanceDefinition{.anchor_a = {0.1, 0.2}},
        DistanceDefinition{.length = 0.9, .spring = spring, .range = Range{0.85, 1.02}},
        PrismaticDefinition{
            .anchor_a = {0.5, 0}, .anchor_b = {-0.5, 0}, .limits = Range{-0.01, 0.02}, .motor = Motor{1, 3}},
        PrismaticDefinition{.anchor_a = {0.5, 0}, .anchor_b = {-0.5, 0}, .spring = spring},
        WeldDefinition{.anchor_a = {0.5, 0}, .anchor_b = {-0.5, 0}, .reference_angle = 0.02 * i},
        WheelDefinition{.anchor_a = {0.5, 0},
                        .anchor_b = {-0.5, 0},
                        .axis = {0, 1},
                        .spring = spring,
                        .limits = Range{-0.02, 0.02},
                        .motor = Motor{2, 1}}};
    bench.motion[b].velocity = {Real(0.1 * (i % 9)), Real(-0.5)};
    bench.join(kinds[i % 6], a, b);
  }
  for (int star = 0; star < 24; ++star) {
    const int hub = bench.body({3.0 * star, 100}, 8, 30);
    for (int i = 0; i < 5; ++i) {
      const int spoke = bench.body({3.0 * star + 0.9, 99.8 + 0.1 * i}, 1, 12, 0.02 * i);
      bench.motion[spoke].velocity = {Real(0.3 * i), Real(-0.3)};
      bench.join(joint(2 + star % 8 + 3 * (i % 2)), hub, spoke);
    }
  }
  return bench;
}

template <class Real>
class JointLanesTest : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(JointLanesTest, Reals);

// Joints side by side have the motion, the impulses and the count of turns that they have one after the
// other, bit for bit, whoever their neighbours are.
TYPED_TEST(JointLanesTest, GiveEachJointTheBitsItHasOneAtATime) {
  using Real = TypeParam;
  JointBench<Real> one = crowd<Real>(false);
  for (int step = 0; step < 60; ++step) one.step(1.0 / (step < 30 ? 60 : 75));
  for (const SolverBody<Real>& m : one.motion) ASSERT_TRUE(std::isfinite(m.angular_velocity));
  test::at_each_vector_width([&](VectorWidth) {
    JointBench<Real> wide = crowd<Real>(true);
    for (int step = 0; step < 60; ++step) wide.step(1.0 / (step < 30 ? 60 : 75));
    for (std::size_t body = 0; body < one.motion.size(); ++body)
      ASSERT_EQ(std::memcmp(&one.motion[body], &wide.motion[body], sizeof one.motion[body]), 0) << body;
    EXPECT_TRUE(bytes_of(one.joints) == bytes_of(wide.joints));
  });
}

// Joints that are solved with their island are only evaluated: they move nothing, and those around them act
// as if they were not there.
TYPED_TEST(JointLanesTest, LeaveJointsOfSolvedIslandsAlone) {
  using Real = TypeParam;
  test::at_each_vector_width([](VectorWidth) {
    JointBench<Real> bench;
    bench.side_by_side = true;
    constexpr int kCount = 40;
    for (int i = 0; i < kCount; ++i) {
      const int a = bench.body({3.0 * i, 0}, 1, 2), b = bench.body({3.0 * i + 1, 0.1}, 1, 2);
      bench.motion[b].velocity = {0, Real(1)};
      bench.join(i % 2 == 0 ? JointKind(RevoluteDefinition{.anchor_a = {1, 0}}) : JointKind(WeldDefinition{}),
                 a, b);
      bench.apart.push_back(i % 3 == 0);
    }
    bench.step(1.0 / 60);
    for (int i = 0; i < kCount; ++i) {
      EXPECT_EQ(bench.motion[2 * i + 1].velocity.y == Real(1), i % 3 == 0) << i;
      EXPECT_EQ(bench.motion[2 * i].velocity.y == Real(0), i % 3 == 0) << i;
    }
  });
}

// More joints at one body than there are colours: those left over share it, and act one after the other. An
// impulse on it that was lost would show in the sum of momenta, which rounding alone may change: half a unit
// in the last place of the hub's 3 kg m/s at each of the sums, of either sign.
TYPED_TEST(JointLanesTest, LoseNoImpulseOfJointsThatShareABody) {
  using Real = TypeParam;
  constexpr int kSpokes = 40;
  JointBench<Real> bench;
  bench.side_by_side = true;
  const int hub = bench.body({0, 0}, 0.1, 0.1);
  for (int i = 0; i < kSpokes; ++i) {
    const double turned = 2 * 3.14159265358979323846 * i / kSpokes, c = std::cos(turned),
                 s = std::sin(turned);
    const int spoke = bench.body({2 * c, 2 * s}, 1, 12, turned);
    bench.motion[spoke].velocity = {Real(0.01 * i), Real(-0.3)};
    bench.join(RevoluteDefinition{.anchor_a = {c, s}, .anchor_b = {-1, 0}}, hub, spoke);
  }
  const auto momentum = [&] {
    Vec2d sum;
    for (const SolverBody<Real>& m : bench.motion)
      sum += (1.0 / m.inverse_mass) * m.velocity.template as<double>();
    return sum;
  };
  const Vec2d before = momentum();
  for (int step = 0; step < 30; ++step) bench.step(1.0 / 60);
  const double sums = 30 * 4 * 3 * kSpokes;  // steps, substeps, sweeps, joints
  const double rounding = std::sqrt(sums) * 0.5 * std::numeric_limits<Real>::epsilon() * 3;
  EXPECT_NEAR(momentum().x, before.x, rounding);
  EXPECT_NEAR(momentum().y, before.y, rounding);
}

}  // namespace
}  // namespace plumb
