#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "tests/world/support.h"

// Impacts of what joints hold. Truth is Newton's law with the joints' impulses, solved by hand: with the
// Jacobian J of the point that is struck and the mass matrix M in the joints' coordinates,
//     lambda = (1 + e) v / (1/m + J M^-1 J^T).
namespace plumb {
namespace {

template <class Real>
class JointedImpacts : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(JointedImpacts, Reals);

constexpr double kLength = 2, kThickness = 0.1, kRadius = 0.1;

template <class Real>
double energy_of(const BasicWorld<Real>& world) {
  double sum = 0;
  for (const BodyId body : world.bodies()) {
    if (world.type(body) != BodyType::Dynamic) continue;
    const double spin = world.angular_velocity(body);
    sum += 0.5 * world.mass(body) * length_squared(world.velocity(body)) +
           0.5 * world.inertia(body) * spin * spin;
  }
  return sum;
}

template <class Real>
Vec2d momentum_of(const BasicWorld<Real>& world) {
  Vec2d sum{};
  for (const BodyId body : world.bodies())
    if (world.type(body) == BodyType::Dynamic) sum += world.mass(body) * world.velocity(body);
  return sum;
}

// Rods that hang from the origin, one below the other, without gravity, and a ball that comes along x at a
// height.
template <class Real>
struct Struck {
  Struck(int count, double restitution, double height, double ball_mass, double speed)
      : world({.gravity = {0, 0}, .sleeping = false}) {
    const Material material{.friction = 0, .restitution = restitution};
    BodyId above = world.create_body({.type = BodyType::Static});
    for (int i = 0; i < count; ++i) {
      const BodyId rod =
          world.create_body({.position = {0, -kLength * (i + 0.5)}}, {.geometry = Box{kThickness, kLength},
                                                                      .density = 1 / (kThickness * kLength),
                                                                      .material = material});
      world.create_joint(above, rod,
                         {.kind = RevoluteDefinition{.anchor_a = {0, i == 0 ? 0 : -kLength / 2},
                                                     .anchor_b = {0, kLength / 2}}});
      rods.push_back(rod), above = rod;
    }
    ball = world.create_body({.position = {-0.5, height}, .velocity = {speed, 0}},
                             {.geometry = Circle{kRadius},
                              .density = ball_mass / (M_PI * kRadius * kRadius),
                              .material = material});
  }

  // Steps until the ball has met a rod.
  void run_to_impact() {
    const double before = world.velocity(ball).x;
    for (int i = 0; i < 60 && world.velocity(ball).x == before; ++i) world.step();
  }

  BasicWorld<Real> world;
  std::vector<BodyId> rods;
  BodyId ball;
};

TYPED_TEST(JointedImpacts, OfAHingedRodKeepItsAngularMomentumAndTheEnergy) {
  for (const double restitution : {1.0, 0.5}) {
    for (const double ball_mass : {0.1, 1.0, 10.0}) {
      for (const double below : {0.6, 1.3, 1.9}) {
        Struck<TypeParam> it(1, restitution, -below, ball_mass, 2);
        it.run_to_impact();
        const double inertia = kLength * kLength / 3;  // of 1 kg about its end
        const double blow = (1 + restitution) * 2 / (1 / ball_mass + below * below / inertia);
        EXPECT_NEAR(it.world.velocity(it.ball).x, 2 - blow / ball_mass, 2e-3) << ball_mass << ' ' << below;
        EXPECT_NEAR(it.world.angular_velocity(it.rods[0]), blow * below / inertia, 2e-3)
            << ball_mass << ' ' << below;
        if (restitution == 1) {
          EXPECT_NEAR(energy_of(it.world), 0.5 * ball_mass * 4, 1e-3 * ball_mass * 2) << below;
        }
      }
    }
  }
}

// Coordinates: the angular velocities of both rods, of 1 kg each.
TYPED_TEST(JointedImpacts, OfADoublePendulumFollowFromItsMassMatrix) {
  for (const double ball_mass : {0.1, 1.0, 10.0}) {
    for (const double below : {0.3, 1.0, 1.9}) {
      Struck<TypeParam> it(2, 1, -kLength - below, ball_mass, 1);
      it.run_to_impact();
      const double m11 = kLength * kLength / 3 + kLength * kLength, m12 = kLength * kLength / 2,
                   m22 = kLength * kLength / 3;
      const double det = m11 * m22 - m12 * m12, j1 = kLength, j2 = below;
      const double u1 = (m22 * j1 - m12 * j2) / det, u2 = (m11 * j2 - m12 * j1) / det;
      const double blow = 2 / (1 / ball_mass + j1 * u1 + j2 * u2);
      EXPECT_NEAR(it.world.velocity(it.ball).x, 1 - blow / ball_mass, 2e-3) << ball_mass << ' ' << below;
      EXPECT_NEAR(it.world.angular_velocity(it.rods[0]), blow * u1, 5e-3) << ball_mass << ' ' << below;
      EXPECT_NEAR(it.world.angular_velocity(it.rods[1]), blow * u2, 5e-3) << ball_mass << ' ' << below;
      EXPECT_NEAR(energy_of(it.world), 0.5 * ball_mass, 1e-3 * ball_mass) << below;
    }
  }
}

// A rod at the limit of its hinge turns away from it when a ball meets it, which slows it down: the limit has
// no part in that, and Newton's law for the rod alone holds. A limit that insisted on the rate at which it
// opens would make the rod a wall, and the energy grow.
TYPED_TEST(JointedImpacts, OfARodThatLeavesItsLimitFollowFromTheRodAlone) {
  constexpr double kSpin = 1, kSpeed = 2;
  for (const double restitution : {1.0, 0.5}) {
    for (const double ball_mass : {0.02, 0.1}) {
      for (const double below : {0.6, 1.3}) {
        Struck<TypeParam> it(1, restitution, -below, ball_mass, -kSpeed);
        auto& world = it.world;
        const BodyId rod = it.rods[0];
        world.change(world.joints(rod)[0],
                     RevoluteDefinition{.anchor_b = {0, kLength / 2}, .limits = Range{0, 1}});
        world.set_angular_velocity(rod, kSpin), world.set_velocity(rod, {kSpin * kLength / 2, 0});
        world.set_position(it.ball, {kThickness / 2 + kRadius + 1e-3, -below}, 0);
        const double before = energy_of(world);
        world.step();
        const double inertia = kLength * kLength / 3;  // of 1 kg about its end
        const double closing = kSpeed + kSpin * below;
        const double blow = (1 + restitution) * closing / (1 / ball_mass + below * below / inertia);
        ASSERT_GT(kSpin - blow * below / inertia, 0);  // it goes on
        EXPECT_NEAR(world.angular_velocity(rod), kSpin - blow * below / inertia, 5e-3) << ball_mass;
        EXPECT_NEAR(world.velocity(it.ball).x, -kSpeed + blow / ball_mass, 1e-2) << ball_mass;
        EXPECT_LT(energy_of(world), before * (1 + 1e-3)) << ball_mass << ' ' << below;
      }
    }
  }
}

// Chains of rods, hinged or welded, that fly freely between balls; all bounces. The rods turn by up to 10
// rad/s after it, which the joints follow to 0.5 % of the energy in steps of 1/60 s. Without joints in the
// impacts a chain keeps 64 % on average.
TYPED_TEST(JointedImpacts, OfFreeChainsKeepEnergyAndMomentum) {
  std::mt19937 dice(5);
  const auto between = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(dice() % 10000) / 9999;
  };
  for (int run = 0; run < 40; ++run) {
    BasicWorld<TypeParam> world({.gravity = {0, 0}, .sleeping = false});
    const Material material{.friction = 0, .restitution = 1};
    BodyId last{};
    const int count = 2 + run % 4;
    for (int i = 0; i < count; ++i) {
      const BodyId rod =
          world.create_body({.position = {0, -1.0 * i}},
                            {.geometry = Box{0.2, 0.9}, .density = between(1, 8), .material = material});
      if (i > 0 && run % 3 == 2)
        world.create_joint(last, rod, {.kind = WeldDefinition{.anchor_a = {0, -0.5}, .anchor_b = {0, 0.5}}});
      if (i > 0 && run % 3 != 2)
        world.create_joint(last, rod,
                           {.kind = RevoluteDefinition{.anchor_a = {0, -0.5}, .anchor_b = {0, 0.5}}});
      last = rod;
    }
    for (int i = 0; i < 3; ++i)
      world.create_body({.position = {i == 1 ? 1.5 : -1.5 - i, between(-count, 0.4)},
                         .velocity = {i == 1 ? -between(1, 4) : between(1, 4), 0}},
                        {.geometry = Circle{0.15}, .density = between(2, 40), .material = material});
    const double energy = energy_of(world);
    const Vec2d before = momentum_of(world);
    double most = 0;
    for (int step = 0; step < 120; ++step) {
      world.step();
      most = std::max(most, energy_of(world));
    }
    EXPECT_LT(most, 1.01 * energy) << run;
    EXPECT_GT(energy_of(world), 0.97 * energy) << run;
    EXPECT_LT(std::sqrt(length_squared(momentum_of(world) - before)),
              1e-4 * std::sqrt(length_squared(before)))
        << run;
  }
}

// Newton's cradle of balls on rods, at rest in a row: the last one takes all speed, and rises as high as the
// first one came from. 1 %: what five impacts of equal masses leave of it in steps of 1/60 s.
TYPED_TEST(JointedImpacts, OfACradleThrowTheLastBallAsHighAsTheFirstFell) {
  constexpr int kBalls = 5;
  BasicWorld<TypeParam> world({.sleeping = false});
  const BodyId frame = world.create_body({.type = BodyType::Static});
  std::vector<BodyId> balls;
  for (int i = 0; i < kBalls; ++i) {
    const double x = 0.5 * i, angle = i == 0 ? -1 : 0;
    const BodyId ball =
        world.create_body({.position = {x + std::sin(angle), -std::cos(angle)}, .angle = angle},
                          {.geometry = Circle{0.25}, .material = {.friction = 0, .restitution = 1}});
    world.create_joint(frame, ball, {.kind = RevoluteDefinition{.anchor_a = {x, 0}, .anchor_b = {0, 1}}});
    balls.push_back(ball);
  }
  const auto energy = [&] {
    double sum = energy_of(world);
    for (const BodyId ball : balls) sum += kGravity * world.mass(ball) * (world.position(ball).y + 1);
    return sum;
  };
  const double start = energy();
  double last = 0, between = 0;
  for (int i = 0; i < 300; ++i) {
    world.step();
    EXPECT_NEAR(energy(), start, 0.01 * start) << i;
    last = std::max(last, world.angle(balls.back()));
    for (int k = 1; k + 1 < kBalls; ++k) between = std::max(between, std::abs(world.angle(balls[k])));
  }
  EXPECT_NEAR(last, 1, 0.01);
  EXPECT_LT(between, 0.01);
}

}  // namespace
}  // namespace plumb
