#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/world/heaps.h"
#include "tests/world/support.h"

namespace plumb {
namespace {

std::vector<BodyId> add_tower(World& world, int height, Material material = {}) {
  std::vector<BodyId> boxes;
  for (int i = 0; i < height; ++i) {
    boxes.push_back(add_body(world, {0, 0.5 + i}, {.geometry = Box{1, 1}, .material = material}));
  }
  return boxes;
}

TEST(Resting, ATowerOfTenNeitherSinksNorCreeps) {
  for (const double restitution : {0.0, 1.0}) {
    World world(without_sleep());
    add_ground(world, {.restitution = restitution});
    const std::vector<BodyId> boxes = add_tower(world, 10, {.restitution = restitution});
    run(world, 100000);
    for (int i = 0; i < 10; ++i) {
      EXPECT_NEAR(world.position(boxes[i]).y, 0.5 + i, 1e-4) << restitution;
      EXPECT_NEAR(world.position(boxes[i]).x, 0, 1e-4) << restitution;
    }
  }
}

TEST(Resting, AHeavyBoxRestsOnALightOne) {
  for (const double ratio : {10.0, 100.0, 1000.0}) {
    World world(without_sleep());
    add_ground(world);
    const BodyId light = add_box(world, {0, 0.5}), heavy = add_box(world, {0, 1.5}, ratio);
    for (int i = 0; i < 600; ++i) {
      world.step();
      ASSERT_NEAR(world.position(heavy).y, 1.5, 1e-4) << ratio << " step " << i;
    }
    EXPECT_NEAR(world.position(light).y, 0.5, 1e-4);
  }
}

TEST(Resting, AHeavyBoxThatFallsOnALightOneIsHeld) {
  World world(without_sleep());
  add_ground(world);
  add_box(world, {0, 0.5});
  const BodyId heavy = add_box(world, {0, 2}, 1000);
  double lowest = 9;
  for (int i = 0; i < 600; ++i) {
    world.step();
    lowest = std::min(lowest, world.position(heavy).y);
  }
  EXPECT_GT(lowest, 1.45);
  EXPECT_NEAR(world.position(heavy).y, 1.5, 1e-3);
}

TEST(Resting, APyramidStands) {
  World world(without_sleep());
  add_ground(world);
  const int base = 10;
  const std::vector<BodyId> boxes = add_pyramid(world, base);
  run(world, 600);
  // Its contacts yield by 4.1 mm in all rows together to a load that is new, and by a tenth of that to one
  // that they expect; of the rest (1 - 0.01)^600 = 0.2 % is left.
  EXPECT_NEAR(world.position(boxes.back()).y, base - 0.5, 1.5 * 0.42e-3);
  EXPECT_NEAR(world.velocity(boxes.back()).y, 0, 1e-4);
}

TEST(Resting, APyramidOf20RowsLosesItsOverlaps) {
  World world(without_sleep());
  add_ground(world);
  const std::vector<BodyId> boxes = add_pyramid(world, 20);
  run(world, 2000);
  // Contacts that yield to all of their load stay at 1.8 mm; a tenth of it is left, and the top's sinking
  // is the sum over the rows.
  EXPECT_LT(deepest(world, boxes), 0.3e-3);
  EXPECT_NEAR(world.position(boxes.back()).y, 19.5, 20 * 0.15e-3);
  for (const BodyId box : boxes) {
    EXPECT_NEAR(world.velocity(box).x, 0, 1e-4);
    EXPECT_NEAR(world.velocity(box).y, 0, 1e-4);
  }
}

// 1275 boxes, 50 of them above one another: within 1 mm of contact after 15 s, with room to spare.
TEST(Resting, APyramidOf50RowsLosesItsOverlaps) {
  World world(without_sleep());
  add_ground(world);
  const std::vector<BodyId> boxes = add_pyramid(world, 50);
  run(world, 900);
  EXPECT_LT(deepest(world, boxes), 0.7e-3);
  // It does not sway either: a thousandth of a width a second is a tenth of what would keep it from sleep.
  for (const BodyId box : boxes) EXPECT_LT(std::abs(world.velocity(box).x), 5e-3);
}

TEST(Sleeping, ATowerFallsAsleepAndWakesWhenItsSupportGoes) {
  World world;
  add_ground(world);
  const std::vector<BodyId> boxes = add_tower(world, 5);
  run(world, 90);
  EXPECT_EQ(world.counts().awake, 0);
  const std::uint64_t asleep = world.hash();
  run(world, 10);
  EXPECT_EQ(world.hash(), asleep);
  world.destroy(boxes[0]);
  EXPECT_EQ(world.counts().awake, 4);
  run(world, 120);
  EXPECT_NEAR(world.position(boxes[1]).y, 0.5, 1e-3);
  EXPECT_NEAR(world.position(boxes[4]).y, 3.5, 1e-3);
  EXPECT_EQ(world.counts().awake, 0);
}

// A static box is put into one that stands between walls, with a heavy one on it: it presses it into the
// ground. What is pushed apart is not at rest; without the other it stands and sleeps.
TEST(Sleeping, WaitsForShapesThatLieInEachOther) {
  World world;
  add_ground(world);
  const BodyId low = add_box(world, {0, 0.5}), high = add_box(world, {0, 1.5}, 3200);
  for (const double side : {-1, 1})
    world.create_body({.type = BodyType::Static, .position = {side, 0.4}},
                      ShapeDefinition{.geometry = Box{1, 0.8}});
  const BodyId intruder = world.create_body({.type = BodyType::Static, .position = {30, 40}},
                                            ShapeDefinition{.geometry = Box{0.5, 0.5}});
  run(world, 120);
  ASSERT_FALSE(world.awake(low) || world.awake(high));
  world.set_position(intruder, {-0.06, 0.75}, 0);
  run(world, 300);
  EXPECT_TRUE(world.awake(low));
  world.set_position(intruder, {30, 40}, 0);
  run(world, 300);
  EXPECT_FALSE(world.awake(low) || world.awake(high));
}

// A body at rest that is struck in whichever step, also in the one in which it would fall asleep, takes the
// impulse: momentum stays, and the light disc leaves at 2 m1/(m1 + m2) times the heavy one's speed.
TEST(Sleeping, AHitCountsInTheVeryStepInWhichABodyWouldFallAsleep) {
  for (int steps = 25; steps < 40; ++steps) {
    DoubleWorld world({.gravity = {0, 0}});
    const ShapeDefinition disc{.geometry = Circle{0.25}, .material = {.friction = 0, .restitution = 1}};
    const double apart = 0.5 + 2 * (steps + 0.4) / 60;
    const BodyId heavy = world.create_body(
        {.position = {-apart, 0}, .velocity = {2, 0}, .mass = MassProperties{10, {}, 1}}, disc);
    const BodyId light = world.create_body({.mass = MassProperties{1, {}, 0.1}}, disc);
    run(world, 45);
    EXPECT_NEAR(world.velocity(heavy).x, 18.0 / 11, 1e-9) << steps;
    EXPECT_NEAR(world.velocity(light).x, 40.0 / 11, 1e-9) << steps;
  }
}

TEST(Sleeping, AHitWakesTheWholeIslandAndNoOther) {
  World world;
  add_ground(world);
  const std::vector<BodyId> hit = add_tower(world, 3);
  const BodyId other = add_box(world, {20, 0.5});
  run(world, 90);
  ASSERT_EQ(world.counts().awake, 0);
  add_body(world, {-3, 1.5}, {.geometry = Circle{0.3}}, {10, 0});
  bool woke = false;
  for (int i = 0; i < 60; ++i) {
    world.step();
    woke = woke || world.awake(hit[0]);
  }
  EXPECT_TRUE(woke);
  EXPECT_FALSE(world.awake(other));
  EXPECT_GT(std::abs(world.position(hit[1]).x), 1e-3);
}

TEST(Sleeping, MovingPlatformsKeepTheirLoadAwake) {
  World world;
  BodyDefinition definition;
  definition.type = BodyType::Kinematic;
  definition.velocity = {0.2, 0};
  world.create_body(definition, ShapeDefinition{.geometry = Box{10, 1}});
  const BodyId box = add_box(world, {0, 1});
  run(world, 300);
  EXPECT_TRUE(world.awake(box));
  EXPECT_NEAR(world.velocity(box).x, 0.2, 5e-5);  // measured 1.7e-5
}

TEST(Sleeping, EndsWhenTheSupportIsPutElsewhere) {
  for (const BodyType support : {BodyType::Dynamic, BodyType::Static}) {
    World world;
    add_ground(world);
    const std::vector<BodyId> boxes = add_tower(world, 3);
    world.set_type(boxes[0], support);
    run(world, 90);
    ASSERT_EQ(world.counts().awake, 0);
    world.set_position(boxes[0], {20, 0.5}, 0);
    run(world, 120);
    EXPECT_NEAR(world.position(boxes[1]).y, 0.5, 1e-3);
    EXPECT_NEAR(world.position(boxes[2]).y, 1.5, 1e-3);
  }
}

TEST(Sleeping, EndsWhenGravityChanges) {
  World world;
  add_ground(world);
  const BodyId box = add_box(world, {0, 0.5});
  run(world, 90);
  ASSERT_FALSE(world.awake(box));
  world.set_gravity({0, kGravity});
  run(world, 30);
  EXPECT_NEAR(world.velocity(box).y, kGravity / 2, 30 * 0x1p-22);  // it falls upwards
}

TEST(Sleeping, CanBeForbidden) {
  World world;
  add_ground(world);
  const BodyId box = add_box(world, {0, 0.5});
  world.set_may_sleep(box, false);
  run(world, 200);
  EXPECT_TRUE(world.awake(box));
  world.set_may_sleep(box, true);
  run(world, 200);
  EXPECT_FALSE(world.awake(box));
  world.set_awake(box, true);
  EXPECT_TRUE(world.awake(box));
  world.set_awake(box, false);
  EXPECT_FALSE(world.awake(box));
}

TEST(Continuous, NothingGetsThroughAThinWallAtAnySpeed) {
  for (const double speed : {10.0, 1e3, 1e5, 1e8}) {
    World world(weightless());
    BodyDefinition wall;
    wall.type = BodyType::Static;
    world.create_body(wall, ShapeDefinition{.geometry = Box{0.001, 100}});
    const BodyId ball = add_body(world, {-10.003, 0.1}, {.geometry = Circle{0.05}}, {speed, 0});
    for (int i = 0; i < 120; ++i) {
      const double before = world.velocity(ball).x;
      world.step();
      ASSERT_LT(world.position(ball).x, -0.04) << speed;
      // Its speed changes by its contact alone: on the way, and where it was stopped, it is what it was.
      ASSERT_TRUE(world.velocity(ball).x == before || world.position(ball).x > -0.2) << speed;
    }
  }
}

TEST(Continuous, BulletsMeetEachOtherInFlight) {
  for (const double speed : {1e2, 1e4, 1e6}) {
    World world(weightless());
    const BodyId a = add_body(world, {-30.1, 0}, {.geometry = Circle{0.05}}, {speed, 0});
    const BodyId b = add_body(world, {30, 0}, {.geometry = Circle{0.05}}, {-speed, 0});
    run(world, 120);
    EXPECT_LT(world.position(a).x, world.position(b).x) << speed;
    EXPECT_NEAR(world.velocity(a).x + world.velocity(b).x, 0, 1e-6 * speed);
  }
}

TEST(Continuous, ASpinningRodDoesNotReachThroughAWall) {
  World world(weightless());
  BodyDefinition wall;
  wall.type = BodyType::Static;
  world.create_body(wall, ShapeDefinition{.geometry = Box{0.02, 20}});
  BodyDefinition rod;
  rod.position = {-1.3, 0};
  rod.velocity = {300, 0};
  rod.angular_velocity = 200;
  const BodyId body = world.create_body(rod, ShapeDefinition{.geometry = Box{2, 0.02}});
  for (int i = 0; i < 240; ++i) {
    world.step();
    ASSERT_LT(world.position(body).x, 0.02);
  }
}

TEST(Continuous, CanBeSwitchedOff) {
  World world({.gravity = {0, 0}, .continuous = false});
  BodyDefinition wall;
  wall.type = BodyType::Static;
  world.create_body(wall, ShapeDefinition{.geometry = Box{0.001, 100}});
  const BodyId ball = add_body(world, {-10.003, 0.1}, {.geometry = Circle{0.05}}, {1e3, 0});
  run(world, 10);
  EXPECT_GT(world.position(ball).x, 100);
}

}  // namespace
}  // namespace plumb
