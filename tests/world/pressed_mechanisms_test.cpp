#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/world/world.h"

// Kinematic bodies push with whatever force it takes. Mechanisms that a wall holds must yield to them, free
// ones must follow, and loads must ride on them.
namespace plumb {
namespace {

template <class Real>
class PressedMechanisms : public testing::Test {};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(PressedMechanisms, Precisions);

// Boxes of 1 m side by side on a floor, from x = 0 on, joined in pairs at the middle of the sides they share.
template <class Real>
std::vector<BodyId> add_row(BasicWorld<Real>& world, int count, double density) {
  std::vector<BodyId> all;
  for (int i = 0; i < count; ++i) {
    all.push_back(world.create_body({.position = {i + 0.5, 0.5}},
                                    ShapeDefinition{.geometry = Box{1, 1}, .density = i % 2 ? density : 1}));
    if (i % 2)
      world.create_joint(all[i - 1], all[i],
                         {.kind = RevoluteDefinition{.anchor_a = {0.5, 0}, .anchor_b = {-0.5, 0}}});
  }
  return all;
}

template <class Real>
double fastest(const BasicWorld<Real>& world, const std::vector<BodyId>& bodies) {
  double most = 0;
  for (const BodyId body : bodies) {
    const Vec2d v = world.velocity(body);
    most = std::max(most, std::hypot(v.x, v.y));
  }
  return most;
}

// A straight column between a wall and a press is unstable: rigid, it would buckle at the speed of the press
// over the angle by which it is bent, without limit. Contacts whose compliance is 1 % of their mobility bound
// that by 1 / (2 sqrt(0.01)) = 5, the most of s / (s^2 + 0.01). Overlaps are pushed out at up to 1 m/s, and a
// row that has risen falls from there.
TYPED_TEST(PressedMechanisms, ColumnsBetweenAWallAndAPressAreNotThrownOut) {
  for (const int count : {2, 4, 6}) {
    for (const double density : {1.0, 20.0}) {
      for (const double speed : {0.2, 1.0})
        for (const double gap : {0.05, 0.053, 0.057, 0.071, 0.09}) {
          BasicWorld<TypeParam> world;
          const BodyId room = world.create_body({.type = BodyType::Static});
          world.create_shape(room, {.geometry = Box{20, 1}, .position = {0, -0.5}});
          world.create_shape(room, {.geometry = Box{1, 6}, .position = {-0.5, 3}});
          const BodyId press = world.create_body(
              {.type = BodyType::Kinematic, .position = {count + 0.5 + gap, 1}, .velocity = {-speed, 0}},
              ShapeDefinition{.geometry = Box{1, 2}});
          const std::vector<BodyId> boxes = add_row(world, count, density);
          const int in = static_cast<int>(std::lround(60 * 0.35 / speed));  // 0.3 m into the row
          double most = 0, rise = 0;
          for (int i = 0; i < 2 * in + 60; ++i) {
            if (i == in) world.set_velocity(press, {speed, 0});
            if (i == 2 * in) world.set_velocity(press, {});
            world.step(1.0 / 60, 4);
            most = std::max(most, fastest(world, boxes));
            for (const BodyId box : boxes) rise = std::max(rise, world.position(box).y - 0.5);
          }
          EXPECT_LT(most, std::hypot(5 * speed + 1, std::sqrt(2 * 9.81 * rise)))
              << count << " boxes, density " << density << ", press of " << speed << " m/s from " << gap
              << " m";
        }
    }
  }
}

// Of the speed that a free body lacks, its contact leaves 1 % in each of four substeps.
TYPED_TEST(PressedMechanisms, FreeOnesReachTheSpeedOfWhatPushesThemInAStep) {
  BasicWorld<TypeParam> world({.gravity = {}});
  world.create_body({.type = BodyType::Kinematic, .position = {-0.5, 0.5}, .velocity = {2, 0}},
                    ShapeDefinition{.geometry = Box{1, 1}});
  const std::vector<BodyId> boxes = add_row(world, 2, 1);
  for (int i = 0; i < 2; ++i) world.step(1.0 / 60, 4);
  for (const BodyId box : boxes) EXPECT_NEAR(world.velocity(box).x, 2, 1e-4);
}

// Contacts yield to no load that they have carried before: at 1 % of the mobility, 500 times the weight of
// what stands on the lift would sink into it at 1 % of 500 g h, 0.2 m/s. Positions are those of bodies that
// rest on each other, of which none may be deeper than 1 mm.
TYPED_TEST(PressedMechanisms, HeavyLoadsRideOnALift) {
  BasicWorld<TypeParam> world;
  const BodyId lift =
      world.create_body({.type = BodyType::Kinematic, .position = {1, -0.5}, .velocity = {0, 1}},
                        ShapeDefinition{.geometry = Box{6, 1}});
  const std::vector<BodyId> boxes = add_row(world, 2, 1);
  const BodyId load =
      world.create_body({.position = {1, 1.5}}, ShapeDefinition{.geometry = Box{2, 1}, .density = 500});
  for (int i = 0; i < 240; ++i) {
    world.step(1.0 / 60, 4);
    if (i < 120) continue;
    const double top = world.position(lift).y + 0.5;
    for (const BodyId box : boxes) ASSERT_NEAR(world.position(box).y - 0.5 - top, 0, 1e-3) << "step " << i;
    ASSERT_NEAR(world.position(load).y - 1.5 - top, 0, 1e-3) << "step " << i;
  }
}

}  // namespace
}  // namespace plumb
