#include "engine/world/add_scene.h"

#include <gtest/gtest.h>

#include "engine/scene/error.h"
#include "tests/world/support.h"

namespace plumb {
namespace {

// A pendulum on a rod, a box on the ground, and a ball that flies.
Scene example() {
  Scene scene;
  scene.gravity = {0, -10};
  Body ground{.name = "ground", .type = BodyType::Static, .position = {0, -1}};
  ground.shapes = {{.geometry = Box{40, 2}}};
  Body box{.name = "box", .position = {5, 0.5}, .mass = 3};
  box.shapes = {{.geometry = Box{1, 1}}};
  Body bob{.name = "bob", .position = {-3, 5}, .mass = 2, .inertia = 0.5};
  Body ball{.name = "ball", .position = {0, 30}, .velocity = {2, 0}};
  ball.shapes = {{.geometry = Circle{0.25}}};
  scene.bodies = {ground, box, bob, ball};
  scene.joints = {
      DistanceJoint{.name = "rod", .body_a = "world", .body_b = "bob", .anchor_a = {-3, 7}, .length = 2}};
  return scene;
}

TEST(AddScene, BodiesAndJointsBehaveAsTheSceneSays) {
  const Scene scene = example();
  DoubleWorld world(world_definition(scene));
  const SceneParts parts = add_scene(world, scene);
  ASSERT_EQ(parts.bodies.size(), 4u);
  ASSERT_EQ(parts.joints.size(), 1u);
  EXPECT_EQ(world.name(parts.bodies[1]), "box");
  EXPECT_EQ(world.mass(parts.bodies[1]), 3);
  EXPECT_NEAR(world.inertia(parts.bodies[1]), 3 * 2 / 12.0, 1e-12);
  EXPECT_EQ(world.inertia(parts.bodies[2]), 0.5);
  run(world, 60);
  EXPECT_NEAR(world.position(parts.bodies[3]).y, 30 - 10.0 / 2, 1e-9);
  EXPECT_NEAR(world.position(parts.bodies[3]).x, 2, 1e-9);
  EXPECT_NEAR(world.position(parts.bodies[1]).y, 0.5, 1e-3);
  EXPECT_NEAR(world.position(parts.bodies[2]).y, 5, 1e-3);
  EXPECT_NEAR(world.read(parts.joints[0]).force, 20, 1e-2);
}

TEST(AddScene, WhatAWorldLacksIsRefusedBeforeAnythingChanges) {
  World world;
  Scene scene = example();
  scene.forces = {LinearDrag{.body = "ball", .coefficient = 1}};
  EXPECT_THROW(add_scene(world, scene), Error);
  scene = example();
  scene.bodies[1].mass = -1;
  EXPECT_THROW(add_scene(world, scene), Error);
  EXPECT_EQ(world.counts().bodies, 0);
}

}  // namespace
}  // namespace plumb
