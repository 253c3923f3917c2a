#include <gtest/gtest.h>

#include <cmath>

#include "tests/world/support.h"

// Bodies that come fast for the other one's size, and slowly for their own.
namespace plumb {
namespace {

constexpr double kStep = 1.0 / 60;

// An 8 m square comes to squares of 0.4 m at 40 m/s, 0.67 m a step: none of its way is followed. It pushes
// the small one before it, without an overlap in any step, wherever in a step it gets to it.
template <class Real>
void strike(double gap, BodyType type, Real) {
  BasicWorld<Real> world(weightless());
  BodyDefinition ram;
  ram.type = type;
  ram.velocity = {40, 0};
  const BodyId large = world.create_body(ram, ShapeDefinition{.geometry = Box{8, 8}, .density = 8});
  // A body put into the world has no look ahead in its first step: it gets there in the third.
  const BodyId small = add_box(world, {4 + gap + 2 * 40 * kStep + 0.2, 0.3}, 1, 0.4, 0.4);
  for (int step = 0; step < 6; ++step) {
    world.step(kStep, 4);
    const double open = world.position(small).x - 0.2 - (world.position(large).x + 4);
    // The first contact is found within a thousandth of the small one's extent; what follows dissolves.
    EXPECT_GT(open, -1e-3 * 0.29) << "gap " << gap << ", step " << step;
  }
  // They go on together: m v is what it was. Off its middle the large one turns a little.
  const double mass = 8 * 64, light = 0.16;
  const double together = type == BodyType::Dynamic ? 40 * mass / (mass + light) : 40;
  EXPECT_NEAR(world.velocity(small).x, together, 2e-3) << gap;
  EXPECT_NEAR(world.velocity(small).y, 0, 2e-2) << gap;
}

TEST(Encounters, WhatIsStruckByALargeOneIsPushedFromWhereItIs) {
  for (const double gap : {0.16, 0.3, 0.467, 0.65}) {
    strike(gap, BodyType::Dynamic, float());
    strike(gap, BodyType::Kinematic, float());
    strike(gap, BodyType::Dynamic, double());
  }
}

// A plane of contact that is drawn before the shapes are there catches what passes beside it.
TEST(Encounters, WhatPassesBesideIsLeftAlone) {
  for (const double offset : {4.2005, 4.25, 4.4}) {
    World world(weightless());
    BodyDefinition ram;
    ram.velocity = {40, 0};
    world.create_body(ram, ShapeDefinition{.geometry = Box{8, 8}, .density = 8});
    const BodyId small = add_box(world, {4 + 0.467 + 2 * 40 * kStep + 0.2, offset}, 1, 0.4, 0.4);
    run(world, 30);
    EXPECT_EQ(world.velocity(small), (Vec2d{0, 0})) << offset;
    EXPECT_EQ(world.angular_velocity(small), 0) << offset;
  }
}

// A turning arm strikes with the side that it has when it gets there.
TEST(Encounters, AnArmStrikesWhereItHasTurnedTo) {
  World world(weightless());
  BodyDefinition arm;
  arm.type = BodyType::Kinematic;
  arm.angular_velocity = 5;  // 10 m from its axis a step is 0.83 m long
  world.create_body(arm, ShapeDefinition{.geometry = Box{40, 1}});
  const BodyId disc = add_body(world, {10, 1.2}, {.geometry = Circle{0.25}, .material = {.friction = 0}});
  run(world, 1);
  // The arm's upper side is 0.5 m above its middle line, which now points along (cos 5 t, sin 5 t).
  const double t = kStep, angle = 5 * t;
  const Vec2d p = world.position(disc), up{-std::sin(angle), std::cos(angle)};
  EXPECT_NEAR(dot(p, up), 0.75, 2e-2);
  EXPECT_GT(dot(p, up), 0.75 - 2e-3);
  EXPECT_NEAR(dot(world.velocity(disc), up), 5 * 10, 1);
}

}  // namespace
}  // namespace plumb
