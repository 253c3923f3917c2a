#include <gtest/gtest.h>

#include "engine/world/world.h"

namespace plumb {
namespace {

// Bodies on joints that keep them from parting from what they touch. Nothing presses such a contact, so it
// has no friction: what joint and contact could press against each other comes from nothing.
template <class Real>
class GuidedContacts : public testing::Test {};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(GuidedContacts, Precisions);

constexpr double kDt = 1.0 / 60;

WorldDefinition with_gravity(double g) {
  WorldDefinition out;
  out.gravity = {0, -g};
  out.sleeping = false;
  return out;
}

TYPED_TEST(GuidedContacts, AWheelOnAnAxleTurnsOnTheFloorThatItTouches) {
  BasicWorld<TypeParam> w(with_gravity(0));
  const BodyId floor =
      w.create_body({.type = BodyType::Static, .position = {0, -1}}, {.geometry = Box{40, 2}});
  const BodyId wheel = w.create_body({.position = {0, 0.5}}, {.geometry = Circle{0.5}});
  w.create_joint(floor, wheel, {.kind = RevoluteDefinition{.anchor_a = {0, 1.5}}, .collide = true});
  for (int i = 0; i < 60; ++i) {
    w.apply_torque(wheel, 10);
    w.step(kDt);
  }
  const double free = 10 / w.inertia(wheel);  // rad/s, after 1 s
  EXPECT_NEAR(w.angular_velocity(wheel), free, 1e-3 * free);
}

TYPED_TEST(GuidedContacts, ALiftOnARailFallsAlongTheWallThatItTouches) {
  BasicWorld<TypeParam> w(with_gravity(10));
  const BodyId wall =
      w.create_body({.type = BodyType::Static}, {.geometry = Box{1, 100}, .position = {1, 0}});
  const BodyId lift = w.create_body({}, {.geometry = Box{1, 1}});
  w.create_joint(wall, lift, {.kind = PrismaticDefinition{.axis = {0, 1}}, .collide = true});
  for (int i = 0; i < 60; ++i) w.step(kDt);
  EXPECT_NEAR(w.position(lift).y, -5, 0.01);
}

// The floor may carry the drawer's weight or leave it to the slider, so its friction is at most mu m g.
TYPED_TEST(GuidedContacts, ADrawerSlidesOnTheFloorThatItTouches) {
  for (const double friction : {0.1, 0.4, 1.0}) {
    BasicWorld<TypeParam> w(with_gravity(10));
    const Material material{.friction = friction};
    const BodyId floor = w.create_body({.type = BodyType::Static, .position = {0, -1}},
                                       {.geometry = Box{1000, 2}, .material = material});
    const BodyId drawer =
        w.create_body({.position = {0, 0.25}}, {.geometry = Box{1, 0.5}, .material = material});
    w.create_joint(floor, drawer, {.kind = PrismaticDefinition{.anchor_a = {0, 1.25}}, .collide = true});
    const double push = 3 * 10 * w.mass(drawer);
    for (int i = 0; i < 60; ++i) {
      w.apply_force(drawer, {push, 0});
      w.step(kDt);
    }
    EXPECT_GT(w.position(drawer).x, 0.5 * (30 - friction * 10) * 0.99) << friction;
    EXPECT_LT(w.position(drawer).x, 0.5 * 30 * 1.02) << friction;
  }
}

// A block that only its weight presses on the floor of the slider's other bodies sticks, as without the
// slider.
TYPED_TEST(GuidedContacts, WhatIsPressedByALoadSticks) {
  BasicWorld<TypeParam> w(with_gravity(10));
  const BodyId floor =
      w.create_body({.type = BodyType::Static, .position = {0, -1}}, {.geometry = Box{40, 2}});
  const BodyId block =
      w.create_body({.position = {0, 0.5}}, {.geometry = Box{1, 1}, .material = {.friction = 0.5}});
  const BodyId hook = w.create_body({.position = {0, 3}});
  w.create_joint(hook, block, {.kind = PrismaticDefinition{.anchor_b = {0, 2.5}, .axis = {0, 1}}});
  w.create_joint(floor, hook, {.kind = PrismaticDefinition{.anchor_a = {0, 4}, .axis = {1, 0}}});
  for (int i = 0; i < 60; ++i) {
    w.apply_force(block, {4, 0});  // below the friction limit, 0.5 * 10 N
    w.step(kDt);
  }
  EXPECT_NEAR(w.position(block).x, 0, 1e-3);
}

}  // namespace
}  // namespace plumb
