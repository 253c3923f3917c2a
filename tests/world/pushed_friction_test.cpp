#include <gtest/gtest.h>

#include "tests/world/support.h"

namespace plumb {
namespace {

// Forces below the limit of friction that begin and end suddenly.
template <class Real>
class PushedFriction : public testing::Test {};

using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(PushedFriction, Reals);

TYPED_TEST(PushedFriction, ABlockPushedInPulsesDoesNotCreep) {
  for (const int period : {2, 4, 10}) {
    SCOPED_TRACE(period);
    BasicWorld<TypeParam> world;
    world.create_body({.type = BodyType::Static, .position = {0, -1}},
                      ShapeDefinition{.geometry = Box{100, 2}, .material = {.friction = 1}});
    const BodyId block = world.create_body(
        {.position = {0, 0.1}}, ShapeDefinition{.geometry = Box{1, 0.2}, .material = {.friction = 1}});
    for (int i = 0; i < 60; ++i) world.step();
    const double start = world.position(block).x, limit = world.mass(block) * kGravity;
    for (int i = 0; i < 600; ++i) {
      if (i % period < period / 2) world.apply_force(block, {0.9 * limit, 0});
      world.step();
    }
    // Without friction, each pulse would move it by g / (2 * 60^2) = 1.4 mm; 10 s have 60 to 300 pulses.
    EXPECT_NEAR(world.position(block).x, start, 1e-5);
  }
}

TYPED_TEST(PushedFriction, ALightSheetPulledUnderAHeavyBlockTakesItAlong) {
  for (const double ratio : {1.0, 10.0, 50.0, 200.0}) {
    SCOPED_TRACE(ratio);
    BasicWorld<TypeParam> world;
    world.create_body({.type = BodyType::Static, .position = {0, -1}},
                      ShapeDefinition{.geometry = Box{100, 2}, .material = {.friction = 0}});
    const ShapeDefinition sheet_shape{.geometry = Box{40, 0.2}, .material = {.friction = 0.8}},
        block_shape{.geometry = Box{1, 0.5}, .material = {.friction = 0.8}};
    const BodyId sheet = world.create_body({.position = {0, 0.1}}, sheet_shape);
    const BodyId block = world.create_body({.position = {0, 0.45}}, block_shape);
    const double mass = ratio * world.mass(sheet);
    world.set_mass(block, {mass, {}, 0.1 * mass});
    for (int i = 0; i < 60; ++i) world.step();
    const double start = world.position(sheet).x - world.position(block).x;
    // Both accelerate at 0.9 of what friction can transfer to the block.
    const double force = 0.9 * 0.8 * kGravity * (mass + world.mass(sheet));
    for (int i = 0; i < 30; ++i) {
      world.apply_force(sheet, {force, 0});
      world.step();
    }
    // A substep without friction would move the sheet by force / mass(sheet) / 240^2: 0.25 to 25 mm.
    EXPECT_NEAR(world.position(sheet).x - world.position(block).x, start, 5e-5);
  }
}

}  // namespace
}  // namespace plumb
