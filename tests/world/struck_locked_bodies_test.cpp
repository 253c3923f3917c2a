#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/world/support.h"

// Bodies with locked axes that others strike in flight.
namespace plumb {
namespace {

template <class Real>
class StruckLockedBodies : public testing::Test {};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(StruckLockedBodies, Precisions);

// Two discs fall or fly onto a box that floats or lies, with one or both axes locked.
TYPED_TEST(StruckLockedBodies, DoNotMoveAlongTheirLockedAxes) {
  for (unsigned seed = 0; seed < 300; ++seed) {
    std::mt19937 random(seed);
    const auto between = [&](double low, double high) {
      return low + (high - low) * static_cast<double>(random()) * 0x1p-32;
    };
    BasicWorld<TypeParam> world({.sleeping = false});
    world.create_body({.type = BodyType::Static, .position = {0, -1}},
                      ShapeDefinition{.geometry = Box{400, 2}});
    const bool x = seed % 3 != 0, y = seed % 3 != 1;
    const BodyId box = world.create_body(
        {.position = {0, between(0.6, 1)}, .angle = between(-0.3, 0.3), .lock_x = x, .lock_y = y},
        ShapeDefinition{.geometry = Box{between(0.5, 1.5), between(0.5, 1)}, .density = between(0.1, 5)});
    for (int i = 0; i < 2; ++i)
      world.create_body(
          {.position = {between(-1.5, 1.5), between(1.5, 3)}, .velocity = {between(-5, 5), between(-8, 0)}},
          ShapeDefinition{.geometry = Circle{between(0.2, 0.5)},
                          .density = between(0.1, 5),
                          .material = {.restitution = i * between(0, 1)}});
    const Vec2d start = world.centre(box);
    for (int i = 0; i < 90; ++i) world.step();
    const Vec2d moved = world.centre(box) - start;
    EXPECT_EQ(x ? moved.x : 0, 0) << "seed " << seed;
    EXPECT_EQ(y ? moved.y : 0, 0) << "seed " << seed;
  }
}

}  // namespace
}  // namespace plumb
