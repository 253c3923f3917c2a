// Bodies on kinematic platforms that a game moves through poses, step by step: lifts carry what stands on
// them, with its weight and its inertia, and nothing walks or hops.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/world/snapshot.h"
#include "tests/world/support.h"

namespace plumb {
namespace {

constexpr double kStep = 1.0 / 60;

// A lift whose top is at y = A (1 - cos w t), with the peak acceleration `g_share` g.
template <class Real>
struct Lift {
  Lift(double g_share, double hertz)
      : rate(2 * std::acos(-1.0) * hertz), reach(g_share * kGravity / (rate * rate)) {
    platform = world.create_body({.type = BodyType::Kinematic, .position = {0, -0.25}},
                                 ShapeDefinition{.geometry = Box{24, 0.5}});
  }
  void add(Vec2d at) {
    boxes.push_back(world.create_body({.position = at}, ShapeDefinition{.geometry = Box{1, 1}}));
    starts.push_back(at);
  }
  void step() {
    time += kStep;
    world.move_towards(platform, {0, -0.25 + reach * (1 - std::cos(rate * time))}, 0, kStep);
    world.step(kStep);
  }
  // Returns the farthest that a box has moved from its place on the platform, m.
  double moved() const {
    double most = 0;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      const Vec2d by = world.position(boxes[i]) - starts[i];
      most = std::max(most, std::hypot(by.x, by.y - (world.position(platform).y + 0.25)));
    }
    return most;
  }
  double moved_in(double seconds) {
    run(world, 30);
    double most = 0;
    while (time < seconds) step(), most = std::max(most, moved());
    return most;
  }

  BasicWorld<Real> world;
  BodyId platform;
  std::vector<BodyId> boxes;
  std::vector<Vec2d> starts;
  double rate, reach, time = 0;
};

template <class Real>
class Lifts : public testing::Test {};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(Lifts, Precisions);

TYPED_TEST(Lifts, CarryStacksWhileTheyAccelerateByLessThanGravity) {
  for (const double hertz : {0.25, 0.5, 1.0, 2.0}) {
    for (const double share : {0.6, 0.9}) {
      Lift<TypeParam> lift(share, hertz);
      for (int i = 0; i < 8; ++i) lift.add({0, 0.5 + i});
      EXPECT_LT(lift.moved_in(12), 5e-4) << hertz << " " << share;
    }
  }
}

TYPED_TEST(Lifts, CarryPyramidsWithoutCreep) {
  for (const double share : {0.3, 0.9}) {
    Lift<TypeParam> lift(share, 0.5);
    for (int row = 0; row < 5; ++row)
      for (int i = 0; i < 5 - row; ++i) lift.add({(i - 0.5 * (4 - row)) * 1.05, 0.5 + row});
    EXPECT_LT(lift.moved_in(10), 2e-3) << share;
  }
}

// The game's pose is reached at the end of each step, and its velocity is what reads: also with riders.
TYPED_TEST(Lifts, ReachEveryPoseThatTheyAreGiven) {
  Lift<TypeParam> lift(0.9, 1);
  lift.add({0, 0.5});
  const double unit = std::numeric_limits<TypeParam>::epsilon();
  for (int i = 0; i < 240; ++i) {
    const double before = lift.world.position(lift.platform).y;
    lift.step();
    const double after = lift.world.position(lift.platform).y;
    EXPECT_NEAR(after, -0.25 + lift.reach * (1 - std::cos(lift.rate * lift.time)), 8 * unit);
    EXPECT_NEAR(lift.world.velocity(lift.platform).y, (after - before) / kStep, 600 * unit);
  }
}

// Turns through poses are ramped like moves: a box on a rocking platform stays where friction holds it.
TYPED_TEST(Lifts, ReachEveryAngleThatTheyAreGiven) {
  BasicWorld<TypeParam> world;
  const BodyId platform = world.create_body({.type = BodyType::Kinematic, .position = {0, -0.25}},
                                            ShapeDefinition{.geometry = Box{4, 0.5}});
  const BodyId box = add_box(world, {1, 0.5});
  run(world, 30);
  for (int i = 1; i <= 240; ++i) {
    const double angle = 0.2 * std::sin(0.05 * i);
    world.move_towards(platform, {0, -0.25}, angle, kStep);
    world.step(kStep);
    EXPECT_NEAR(world.angle(platform), angle, 240 * std::numeric_limits<TypeParam>::epsilon());
  }
  EXPECT_NEAR(world.angle(box), world.angle(platform), 1e-3);
}

// A platform of constant velocity moves equally in all substeps, whatever the length of the steps and the
// number of their substeps.
TYPED_TEST(Lifts, OfConstantVelocityAreTheSameInStepsOfAnyLength) {
  BasicWorld<TypeParam> world;
  const BodyId platform =
      world.create_body({.type = BodyType::Kinematic, .position = {0, -0.25}, .velocity = {2, 1}},
                        ShapeDefinition{.geometry = Box{8, 0.5}});
  const BodyId box =
      world.create_body({.position = {0, 0.5}, .velocity = {2, 1}}, ShapeDefinition{.geometry = Box{1, 1}});
  run(world, 60);
  const Vec2d apart = world.position(box) - world.position(platform);
  for (int i = 0; i < 200; ++i) {
    world.step(i % 3 == 0 ? 1.0 / 120 : i % 3 == 1 ? 1.0 / 60 : 1.0 / 100, 2 + i % 5);
    EXPECT_EQ(world.velocity(platform), (Vec2d{2, 1}));
    EXPECT_NEAR(world.velocity(box).x, 2, 1e-5);
    EXPECT_NEAR(world.velocity(box).y, 1, 1e-3);
  }
  EXPECT_NEAR(world.position(box).x - world.position(platform).x, apart.x, 2e-4);
}

// A platform that starts at once lifts a box with its speed; the ramp is too weak to throw it.
TYPED_TEST(Lifts, ThatStartAtOnceThrowNothing) {
  BasicWorld<TypeParam> world;
  const BodyId platform = world.create_body({.type = BodyType::Kinematic, .position = {0, -0.25}},
                                            ShapeDefinition{.geometry = Box{8, 0.5}});
  const BodyId box = add_box(world, {0, 0.5});
  run(world, 30);
  world.set_velocity(platform, {0, 5});
  for (int i = 0; i < 60; ++i) {
    world.step(kStep);
    EXPECT_NEAR(world.position(box).y - world.position(platform).y, 0.75, 2e-3) << i;
  }
  EXPECT_NEAR(world.velocity(box).y, 5, 1e-3);
}

TYPED_TEST(Lifts, AreRestoredOnTheirWay) {
  Lift<TypeParam> lift(0.9, 1), again(0.9, 1);
  for (int i = 0; i < 4; ++i) lift.add({0, 0.5 + i});
  lift.moved_in(0.3);
  restore(again.world, save(lift.world));
  again.time = lift.time;
  for (int i = 0; i < 60; ++i) lift.step(), again.step();
  EXPECT_EQ(again.world.hash(), lift.world.hash());
}

}  // namespace
}  // namespace plumb
