#include "engine/world/joint_solver/hinge_sweeps.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <iterator>
#include <limits>

#include "tests/world/solver/joint_bench.h"

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

template <class Real>
void add(JointBench<Real>& bench, const Pair& pair, int number) {
  const double x = 3 * number, turned = 0.3 * number;
  const int a = bench.body({x, 0.1 * number}, pair.mass_a, pair.inertia_a, turned);
  const int b = bench.body({x + 0.8, -0.4}, pair.mass_b, pair.inertia_b, -turned);
  if (bench.dynamic(a)) bench.motion[a].velocity = {Real(0.7), Real(-0.2 * number)};
  bench.motion[b].angular_velocity = Real(1 + number);
  const int joint =
      bench.join(RevoluteDefinition{.anchor_a = {0.4, 0.1 * number}, .anchor_b = {-0.5, 0.2}}, a, b);
  if (pair.held) bench.joints.hold(joint);
}

template <class Real>
bool same(const BodyMotion<Real>& a, const BodyMotion<Real>& b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

template <class Real>
class HingeSweeps : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(HingeSweeps, Reals);

// The sums of four joints at a time are those of each joint: bit for bit, whoever its neighbours are.
TYPED_TEST(HingeSweeps, GiveEachJointTheBitsItHasAlone) {
  using Real = TypeParam;
  for (int first = 0; first < 4; ++first) {
    JointBench<Real> together;
    for (int i = first; i < static_cast<int>(std::size(kPairs)); ++i) add(together, kPairs[i], i);
    together.gravity = {0, -10};
    for (int step = 0; step < 60; ++step) together.step(1.0 / 60);
    for (int i = first; i < static_cast<int>(std::size(kPairs)); ++i) {
      JointBench<Real> alone;
      add(alone, kPairs[i], i);
      alone.gravity = {0, -10};
      for (int step = 0; step < 60; ++step) alone.step(1.0 / 60);
      for (int body = 0; body < 2; ++body)
        EXPECT_TRUE(same(alone.motion[body], together.motion[2 * (i - first) + body]))
            << "from " << first << ", pair " << i << ", body " << body;
    }
  }
}

// More joints at one body than there are colours: those left over share it, and act one after the other. An
// impulse on it that was lost would show in the sum of momenta, which rounding alone may change: half a unit
// in the last place of the hub's 3 kg m/s at each of the sums, of either sign.
TYPED_TEST(HingeSweeps, LoseNoImpulseOfJointsThatShareABody) {
  using Real = TypeParam;
  constexpr int kSpokes = 40;
  JointBench<Real> bench;
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
    for (const BodyMotion<Real>& m : bench.motion)
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
