#include "engine/world/add_scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "engine/scene/error.h"
#include "engine/world/scene/scene_forces.h"
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

/// One of everything: what the scene says is what the world's own calls report.
TEST(AddScene, EveryShapeAndJointArrives) {
  Scene scene = example();
  Body rock{.name = "rock", .type = BodyType::Static, .position = {50, 0}};
  rock.shapes = {{.geometry = Capsule{{0, 0}, {1, 0}, 0.5}, .rolling_resistance = 0.25, .surface_speed = 2},
                 {.geometry = Polygon{{{0, 0}, {1, 0}, {0, 1}}, 0.1}},
                 {.geometry = Segment{{0, 0}, {1, 0}}},
                 {.geometry = Chain{{{0, 0}, {1, 0}, {2, 0}, {3, 1}}}, .position = {9, 9}}};
  scene.bodies.push_back(rock);
  scene.bodies[3].gravity_scale = 0.5, scene.bodies[3].linear_damping = 0.1;
  const std::string a = "bob", b = "box";
  scene.joints = {
      RevoluteJoint{.name = "1", .body_a = a, .body_b = b, .break_force = 7, .limits = Range{-1, 1}},
      DistanceJoint{.name = "2", .body_a = a, .body_b = b, .length = 3, .spring = Spring{2, 0.5}},
      PrismaticJoint{.name = "3", .body_a = a, .body_b = b, .motor = Motor{1, 2}},
      WeldJoint{.name = "4", .body_a = a, .body_b = b, .reference_angle = 0.5},
      WheelJoint{.name = "5", .body_a = a, .body_b = b, .spring = Spring{3, 1}},
      MotorJoint{.name = "6", .body_a = a, .body_b = b, .max_force = 4},
      MouseJoint{.name = "7", .body_a = "world", .body_b = b, .target = {1, 2}, .max_force = 3},
      GearJoint{.name = "8", .body_a = a, .body_b = b, .ratio = 2},
      PulleyJoint{.name = "9", .body_a = a, .body_b = b, .ground_a = {-3, 9}, .ground_b = {5, 9}},
      RatchetJoint{.name = "10", .body_a = a, .body_b = b, .tooth = 0.2},
      FrictionJoint{.name = "11", .body_a = a, .body_b = b, .max_force = 6}};
  DoubleWorld world(world_definition(scene));
  const SceneParts parts = add_scene(world, scene);
  ASSERT_EQ(parts.joints.size(), 11u);
  EXPECT_EQ(std::get<RevoluteDefinition>(world.kind(parts.joints[0])).limits->upper, 1);
  EXPECT_EQ(world.definition(parts.joints[0]).break_force, 7);
  EXPECT_EQ(std::get<DistanceDefinition>(world.kind(parts.joints[1])).spring->hertz, 2);
  EXPECT_EQ(std::get<PrismaticDefinition>(world.kind(parts.joints[2])).motor->max_force, 2);
  EXPECT_EQ(std::get<WeldDefinition>(world.kind(parts.joints[3])).reference_angle, 0.5);
  EXPECT_EQ(std::get<WheelDefinition>(world.kind(parts.joints[4])).spring->hertz, 3);
  EXPECT_EQ(std::get<MotorDefinition>(world.kind(parts.joints[5])).max_force, 4);
  EXPECT_EQ(std::get<MouseDefinition>(world.kind(parts.joints[6])).target, (Vec2d{1, 2}));
  EXPECT_EQ(std::get<GearDefinition>(world.kind(parts.joints[7])).ratio, 2);
  EXPECT_EQ(std::get<PulleyDefinition>(world.kind(parts.joints[8])).ground_b, (Vec2d{5, 9}));
  EXPECT_EQ(std::get<RatchetDefinition>(world.kind(parts.joints[9])).tooth, 0.2);
  EXPECT_EQ(std::get<FrictionDefinition>(world.kind(parts.joints[10])).max_force, 6);
  const auto shapes = world.shapes(parts.bodies[4]);
  EXPECT_GE(shapes.size(), 4u);
  EXPECT_EQ(world.material(shapes[0]).surface_speed + world.material(shapes.back()).surface_speed, 2);
}

/// x'' = -k x for a body that nothing else holds: the midpoint method is of second order, so that half the
/// step has a quarter of the error.
TEST(SceneForces, AreOfSecondOrderInFreeFlight) {
  const auto miss = [](int steps) {
    Scene scene{.name = "spring", .gravity = {0, 0}};
    scene.bodies = {{.name = "ball", .position = {1, 0}, .mass = 2, .inertia = 1}};
    scene.forces = {SpringForce{"world", "ball", {-3, 0}, {}, 3, 8}};
    DoubleWorld world(world_definition(scene));
    const SceneParts parts = add_scene(world, scene);
    SceneForces<double> forces(scene, parts);
    const double dt = 1.0 / steps;
    for (int i = 0; i < steps; ++i) forces.apply(world, dt), world.step(dt, 1);
    return std::abs(world.position(parts.bodies[0]).x - std::cos(2.0));
  };
  const double coarse = miss(60), fine = miss(120);
  EXPECT_LT(coarse, 1e-3);
  EXPECT_NEAR(coarse / fine, 4, 0.4);
}

/// However stiff: the implicit midpoint method turns by 2 atan(w h/2) a step, and its amplitude stays.
TEST(SceneForces, SpringsMayBeStiff) {
  for (const double turn : {0.4, 1.0, 10.0, 1e4}) {
    const double dt = 1.0 / 60, k = 2 * (turn / dt) * (turn / dt), angle = 2 * std::atan(turn / 2);
    Scene scene{.name = "spring", .gravity = {0, 0}};
    scene.bodies = {{.name = "ball", .position = {0.1, 0}, .mass = 2, .inertia = 1}};
    scene.forces = {SpringForce{"world", "ball", {-3, 0}, {}, 3, k}};
    DoubleWorld world(world_definition(scene));
    const SceneParts parts = add_scene(world, scene);
    SceneForces<double> forces(scene, parts);
    for (int i = 1; i <= 200; ++i) {
      forces.apply(world, dt), world.step(dt, 1);
      // Rounding of k x enters each step, (w h)^2 eps of x at most.
      EXPECT_NEAR(world.position(parts.bodies[0]).x, 0.1 * std::cos(i * angle), 1e-13 * i * (1 + turn));
    }
  }
}

/// Two bodies, the spring at their corners, damped a thousand times beyond what a step can follow: they come
/// to rest about each other, and what the pair has as a whole is kept.
TEST(SceneForces, DampersMayBeStiff) {
  Scene scene{.name = "damper", .gravity = {0, 0}};
  scene.bodies = {{.name = "a", .velocity = {1, 2}, .mass = 1, .inertia = 0.2},
                  {.name = "b", .position = {2, 0}, .velocity = {-3, 0}, .mass = 3, .inertia = 0.5}};
  scene.forces = {SpringForce{"a", "b", {0.5, 0.2}, {-0.5, 0.3}, 1, 1e4, 1e5}};
  DoubleWorld world(world_definition(scene));
  const SceneParts parts = add_scene(world, scene);
  SceneForces<double> forces(scene, parts);
  const auto energy = [&] {
    double sum = 0;
    for (const BodyId body : parts.bodies) {
      const double w = world.angular_velocity(body);
      sum += world.mass(body) * length_squared(world.velocity(body)) + world.inertia(body) * w * w;
    }
    return sum / 2;
  };
  const double start = energy();
  for (int i = 0; i < 600; ++i) {
    forces.apply(world, 1.0 / 60), world.step(1.0 / 60, 1);
    // The line turns while its tension acts for a step: a share of (w h)^2.
    EXPECT_LT(energy(), 1.02 * start);
  }
  const Vec2d momentum = world.velocity(parts.bodies[0]) + 3.0 * world.velocity(parts.bodies[1]);
  EXPECT_NEAR(momentum.x, 1 - 9, 1e-9);
  EXPECT_NEAR(momentum.y, 2, 1e-9);
}

/// A force that is switched within steps gives its impulse; gravity and the law act together.
TEST(SceneForces, GiveTheirImpulse) {
  Scene scene{.name = "push", .gravity = {0, -10}};
  scene.bodies = {{.name = "ball", .mass = 2, .inertia = 4}};
  scene.forces = {PointForce{"ball", {3, 0}, {}, Frame::World, 0.105, 0.5}, Torque{"ball", 5, 0.2, 0.033}};
  World world(world_definition(scene));
  const SceneParts parts = add_scene(world, scene);
  SceneForces<float> forces(scene, parts);
  for (int i = 0; i < 60; ++i) forces.apply(world, 1.0 / 60), world.step(1.0 / 60, 4);
  EXPECT_NEAR(world.velocity(parts.bodies[0]).x, 3 * 0.5 / 2, 1e-6);
  EXPECT_NEAR(world.velocity(parts.bodies[0]).y, -10, 1e-5);
  EXPECT_NEAR(world.angular_velocity(parts.bodies[0]), 5 * 0.033 / 4, 1e-7);
}

TEST(AddScene, WhatAWorldLacksIsRefusedBeforeAnythingChanges) {
  World world;
  Scene scene = example();
  scene.contact_rules.restitution_threshold = 1;
  EXPECT_THROW(add_scene(world, scene), Error);
  scene = example();
  scene.bodies[1].mass = -1;
  EXPECT_THROW(add_scene(world, scene), Error);
  scene = example();
  scene.bodies[3].position.x = 1e13;  // within a scene's bounds, beyond a world's
  EXPECT_THROW(add_scene(world, scene), Error);
  EXPECT_EQ(world.counts().bodies, 0);
}

}  // namespace
}  // namespace plumb
