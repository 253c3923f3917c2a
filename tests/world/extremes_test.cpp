#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/world/support.h"

// Bodies that are very high, heavy, far or long.
namespace plumb {
namespace {

// The farthest that any of a tower's boxes gets from where it was built, m.
double farthest_in(World& world, const std::vector<BodyId>& boxes, Vec2d foot, int steps) {
  double worst = 0;
  for (int i = 0; i < steps; ++i) {
    world.step();
    for (std::size_t k = 0; k < boxes.size(); ++k) {
      const Vec2d off = world.position(boxes[k]) - foot - Vec2d{0, 0.5 + static_cast<double>(k)};
      worst = std::max({worst, std::abs(off.x), std::abs(off.y)});
    }
  }
  return worst;
}

std::vector<BodyId> add_tower(World& world, int height, Vec2d foot) {
  std::vector<BodyId> boxes;
  for (int i = 0; i < height; ++i) boxes.push_back(add_box(world, foot + Vec2d{0, 0.5 + i}));
  return boxes;
}

// With the sweeps alone a tower of a hundred falls.
TEST(Extremes, ATowerOfAThousandBoxesStands) {
  for (const int height : {100, 1000}) {
    World world(without_sleep());
    add_ground(world);
    const std::vector<BodyId> boxes = add_tower(world, height, {0, 0});
    // The lowest bear 1000 boxes on 2 points by impulses that a float has to 6e-8 of them. Measured 1.4e-6.
    EXPECT_LT(farthest_in(world, boxes, {0, 0}, 120), 4e-6) << height;
  }
}

// A light box between a heavy one and the ground has large impulses from both, whose difference moves it:
// what rounds each of them throws it out from a ratio of 1e8 on.
TEST(Extremes, ABoxBearsOneOfAnyWeight) {
  for (const double ratio : {1e6, 1e7, 3e7, 1e8, 3e8, 1e9}) {
    World world(without_sleep());
    add_ground(world);
    const std::vector<BodyId> boxes{add_box(world, {0, 0.5}), add_box(world, {0, 1.5}, ratio)};
    // The heavy one yields to the first step's load by sharing, 1e-7 of g h a substep; measured 3.2e-8.
    EXPECT_LT(farthest_in(world, boxes, {0, 0}, 300), 1e-7) << ratio;
  }
}

// Floats are 8 m apart at 1e8 m: boxes there must not be told apart by their rounding.
TEST(Extremes, ATowerStandsFarFromTheOrigin) {
  for (const double distance : {1e6, 1e8}) {
    World world(without_sleep());
    const Vec2d foot{distance, distance};
    world.create_body({.type = BodyType::Static, .position = foot},
                      ShapeDefinition{.geometry = Box{200, 2}, .position = {0, -1}});
    const std::vector<BodyId> boxes = add_tower(world, 8, foot);
    // A double has 1.5e-8 m there, and rounds a position by half of it each step.
    EXPECT_LT(farthest_in(world, boxes, foot, 300), 1e-6) << distance;
  }
}

// At 1e8 m/s a step is 1.7e6 m long, of which a float has 0.1 m: discs of 2 cm meet all the same, whatever
// the place in the step.
TEST(Extremes, BulletsMeetAtAnySpeed) {
  for (const double speed : {1e6, 1e7, 1e8}) {
    for (const double steps : {0.3, 1.5, 2.7}) {
      World world(weightless());
      const double away = 0.01 + steps / 60 * speed;
      const ShapeDefinition disc{.geometry = Circle{0.01}};
      const BodyId a = add_body(world, {-away, 0}, disc, {speed, 0});
      const BodyId b = add_body(world, {away, 0}, disc, {-speed, 0});
      run(world, 12);
      EXPECT_LT(world.position(a).x, world.position(b).x) << speed << " after " << steps << " steps";
    }
  }
}

// A ground of 2 km: what is more than a box above it is no pair of it.
TEST(Extremes, ALongGroundIsNotPairedWithWhatIsAboveIt) {
  World world(without_sleep());
  world.create_body({.type = BodyType::Static},
                    ShapeDefinition{.geometry = Box{2000, 2}, .position = {0, -1}});
  for (int i = 0; i < 20; ++i) add_box(world, {-30.0 + 3 * i, i < 10 ? 0.5 : 3.0});
  world.step();
  EXPECT_EQ(world.counts().contacts, 10);
}

// Boxes are paired with a ground before they get to it, however they are thrown at it: none is found in it.
TEST(Extremes, NothingGetsIntoAGroundUnseen) {
  for (int i = 0; i < 60; ++i) {
    World world(without_sleep());
    add_ground(world);
    const BodyId box = add_box(world, {0, 0.6 + 0.05 * i}, 1);
    double deepest = 0;
    for (int step = 0; step < 120; ++step) {
      world.step();
      deepest = std::max(deepest, 0.5 - world.position(box).y);
    }
    // Addition of its weight to a step's way after its boxes were stored: g dt^2 = 2.7 mm.
    EXPECT_LT(deepest, 2.8e-3) << i;
  }
}

}  // namespace
}  // namespace plumb
