#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/world/support.h"

// Impacts within a step: what is thrown back goes on for the rest of the step.
namespace plumb {
namespace {

constexpr double kDt = 1.0 / 60;
const Material kElastic{.friction = 0, .restitution = 1};

template <class Real>
void add_wall(BasicWorld<Real>& world, double x) {
  world.create_body({.type = BodyType::Static, .position = {x, 0}},
                    ShapeDefinition{.geometry = Box{1, 10}, .material = kElastic});
}

// Returns the place of a point that flies between -0.5 and 0.5, from the middle.
double between_walls(double way) {
  const double x = std::fmod(way + 0.5, 2);
  return x < 1 ? x - 0.5 : 1.5 - x;
}

// The farthest that a ball gets from where it is to be, between two walls that it crosses to in `crossing`
// steps.
template <class Real>
double worst_between_walls(double crossing, int steps) {
  BasicWorld<Real> world(weightless());
  constexpr double kRadius = 0.1;
  add_wall(world, -1 - kRadius), add_wall(world, 1 + kRadius);
  const double speed = 1 / (crossing * kDt);
  const BodyId ball =
      add_body(world, {0, 0}, {.geometry = Circle{kRadius}, .material = kElastic}, {speed, 0});
  double worst = 0;
  for (int i = 1; i <= steps; ++i) {
    world.step();
    worst = std::max(worst, std::abs(world.position(ball).x - between_walls(speed * i * kDt)));
    EXPECT_NEAR(std::abs(world.velocity(ball).x), speed, 1e-5 * speed) << i;
    if (testing::Test::HasFailure()) break;
  }
  return worst;
}

// It is thrown back up to twice the tolerance of a time of impact before a wall, 2e-3 of its radius: 4e-4 m
// less of way each time.
TEST(Rebound, ABallKeepsItsTimesBetweenTwoWalls) {
  for (const double crossing : {10.3, 5.7, 2.1}) {
    const int steps = static_cast<int>(100 * crossing);
    EXPECT_LT(worst_between_walls<float>(crossing, steps), 100 * 4e-4) << crossing;
    EXPECT_LT(worst_between_walls<double>(crossing, steps), 100 * 4e-4) << crossing;
  }
}

// At most this many impacts a step, then it waits for the next one: it neither hangs nor gets out.
TEST(Rebound, ABulletInASlotStaysThereWithItsSpeed) {
  World world(weightless());
  add_wall(world, -0.51), add_wall(world, 0.51);
  const BodyId ball = add_body(world, {0, 0}, {.geometry = Circle{0.005}, .material = kElastic}, {1e6, 0});
  for (int i = 0; i < 200; ++i) {
    world.step();
    ASSERT_LT(std::abs(world.position(ball).x), 0.0051) << i;
    ASSERT_NEAR(std::abs(world.velocity(ball).x), 1e6, 10) << i;
  }
}

// A small ball falls 20 m and moves by several of its diameters a step where it lands: parabola after
// parabola, at their times and with their heights.
TEST(Rebound, AFastBallBouncesAtItsTimes) {
  constexpr double kDrop = 20, kRadius = 0.05;
  for (const double e : {1.0, 0.8}) {
    World world(without_sleep());
    add_ground(world, {.friction = 0, .restitution = e});
    const BodyId ball =
        add_body(world, {0, kDrop + kRadius},
                 {.geometry = Circle{kRadius}, .material = {.friction = 0, .restitution = e}}, {3, 0});
    double speed = std::sqrt(2 * kGravity * kDrop), start = -speed / kGravity, worst = 0;
    for (int i = 1; i <= 360; ++i) {
      world.step();
      const double t = i * kDt;
      while (t - start > 2 * speed / kGravity) start += 2 * speed / kGravity, speed *= e;
      const double height = (t - start) * (speed - kGravity * (t - start) / 2);
      worst = std::max(worst, std::abs(world.position(ball).y - kRadius - height));
      // Nothing acts along the ground.
      EXPECT_NEAR(world.position(ball).x, 3 * t, 1e-5) << i;
    }
    // 2e-3 of its radius too high at each of two or three impacts; the time of that, at 20 m/s. Measured
    // 1e-3.
    EXPECT_LT(worst, 3e-3) << e;
  }
}

// Momentum and energy of an impact in flight, of bodies that spin, off their centres.
TEST(Rebound, KeepsMomentumAndEnergy) {
  DoubleWorld world(weightless());
  BodyDefinition left{.position = {-1, 0}, .velocity = {200, 3}, .angular_velocity = 40};
  BodyDefinition right{.position = {1, 0.1}, .velocity = {-150, 0}, .angular_velocity = -30};
  const ShapeDefinition box{.geometry = Box{0.2, 0.1}, .material = kElastic};
  const ShapeDefinition heavy{.geometry = Box{0.3, 0.3}, .density = 3, .material = kElastic};
  const BodyId a = world.create_body(left, box), b = world.create_body(right, heavy);
  const auto momentum = [&] { return world.mass(a) * world.velocity(a) + world.mass(b) * world.velocity(b); };
  const auto energy = [&] {
    double sum = 0;
    for (const BodyId body : {a, b}) {
      const double w = world.angular_velocity(body);
      sum += 0.5 * (world.mass(body) * length_squared(world.velocity(body)) + world.inertia(body) * w * w);
    }
    return sum;
  };
  const Vec2d p = momentum();
  const double e = energy(), before = world.velocity(a).x;
  run(world, 3);
  EXPECT_NE(world.velocity(a).x, before);
  EXPECT_NEAR(momentum().x, p.x, 1e-12 * std::abs(p.x));
  EXPECT_NEAR(momentum().y, p.y, 1e-12 * std::abs(p.x));
  EXPECT_NEAR(energy(), e, 1e-12 * e);
}

// An impact is told in the step that it is in, with its speed, though the shapes are apart again at its end.
TEST(Rebound, IsTold) {
  World world(weightless());
  BodyDefinition wall{.type = BodyType::Static};
  world.create_body(wall, ShapeDefinition{.geometry = Box{0.01, 10}, .material = kElastic});
  add_body(world, {-1.05, 0}, {.geometry = Circle{0.05}, .material = kElastic, .hit_events = true}, {100, 0});
  world.step();
  const Events& events = world.events();
  ASSERT_EQ(events.begin.size(), 1u);
  EXPECT_EQ(events.end.size(), 1u);
  ASSERT_EQ(events.hits.size(), 1u);
  EXPECT_NEAR(events.hits[0].speed, 100, 1e-4);
  EXPECT_NEAR(events.hits[0].point.x, -0.005, 2e-4);
  run(world, 10);
  EXPECT_TRUE(world.events().begin.empty());
}

// Bodies on which something presses, or that a joint holds, are left to the solver: nothing gets out of its
// joints.
TEST(Rebound, LeavesWhatIsHeldToTheSolver) {
  World world(without_sleep());
  add_ground(world);
  const BodyId plate =
      add_body(world, {0, 0.05}, {.geometry = Box{1, 0.1}, .density = 0.1, .material = kElastic});
  run(world, 30);
  add_body(world, {0.1, 10}, {.geometry = Circle{0.05}, .density = 50, .material = kElastic}, {0, -2000});
  for (int i = 0; i < 30; ++i) {
    world.step();
    ASSERT_GT(world.position(plate).y, 0) << i;
  }
}

// A body without restitution loses the share of its velocity into a wall where it meets the wall, and slides
// on along it. The same when others are thrown back in that step.
TEST(Rebound, WithoutRestitutionLeavesTheSpeedAlongTheWall) {
  for (const bool others_bounce : {false, true}) {
    World world(weightless());
    const Material smooth{.friction = 0, .restitution = 0};
    world.create_body({.type = BodyType::Static},
                      ShapeDefinition{.geometry = Box{0.01, 100}, .material = smooth});
    const BodyId bullet =
        add_body(world, {-1.05, 0}, {.geometry = Circle{0.05}, .material = smooth}, {180, 40});
    const BodyId ball = add_body(world, {-1.05, -20}, {.geometry = Circle{0.05}, .material = kElastic},
                                 {others_bounce ? 100.0 : 0, 0});
    world.step();
    EXPECT_NEAR(world.position(bullet).x, -0.055, 1e-6) << others_bounce;
    EXPECT_NEAR(world.position(bullet).y, 40.0 / 60, 1e-6) << others_bounce;
    EXPECT_EQ(world.velocity(bullet), (Vec2d{0, 40})) << others_bounce;
    EXPECT_NEAR(world.velocity(ball).x, others_bounce ? -100 : 0, 1e-4);
    world.step();
    EXPECT_NEAR(world.velocity(bullet).x, 0, 1e-4) << others_bounce;
    EXPECT_EQ(world.velocity(bullet).y, 40) << others_bounce;
  }
}

// A ball is hit by the one that touches it, and stopped in the same step by a third that it meets: it keeps
// what the impact gave it. Heads-on the velocities of equal balls are exchanged, from one to the next.
TEST(Rebound, KeepsTheEnergyOfWhatIsHitAndStoppedWithinAStep) {
  World world(weightless());
  const ShapeDefinition ball{.geometry = Circle{0.5}, .material = kElastic};
  const BodyId balls[] = {add_body(world, {0, 0}, ball, {30, 0}), add_body(world, {1, 0}, ball),
                          add_body(world, {2.1, 0}, ball, {-5, 0})};
  for (int i = 0; i < 8; ++i) {
    world.step();
    double energy = 0;  // in m/2: 30^2 + 5^2
    for (const BodyId each : balls) energy += length_squared(world.velocity(each));
    EXPECT_NEAR(energy, 925, 1e-3) << i;
  }
  EXPECT_NEAR(world.velocity(balls[0]).x, -5, 1e-4);
  EXPECT_NEAR(world.velocity(balls[1]).x, 0, 1e-4);
  EXPECT_NEAR(world.velocity(balls[2]).x, 30, 1e-4);
}

}  // namespace
}  // namespace plumb
