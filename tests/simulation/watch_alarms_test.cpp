// Everyday runs that the watch has nothing to say about, and starts that are no fault of the method.
#include <gtest/gtest.h>

#include <cmath>

#include "engine/scene/error.h"
#include "tests/simulation/scenes.h"

namespace plumb {
namespace {

using namespace plumb::testing;

/// Steps the scene at default settings; an Error fails the test.
Simulation run(const Scene& scene, int steps, const Realtime& accuracy = {}) {
  Simulation world = compile(scene, accuracy);
  EXPECT_NO_THROW(world.step(steps)) << "t = " << world.time();
  EXPECT_EQ(world.doubt(), nullptr);
  return world;
}

/// A column of boxes with gaps between them, above a ground.
Scene column(int count, double size, double gap, double ground = 1) {
  Scene scene = with(empty_scene(), {fixed(box("ground", {0, -ground / 2}, 100, ground))});
  for (int i = 0; i < count; ++i)
    scene.bodies.push_back(
        box("box " + std::to_string(i), {0, size / 2 + i * (size + gap) + gap}, size, size));
  return scene;
}

// Boxes that land on each other lie in each other for a while, up to 4 % of their size. That goes.
TEST(WatchAlarms, ColumnsMayFall) {
  for (const auto& [count, size, gap] : {std::tuple{4, 0.1, 0.1},
                                         {5, 0.1, 0.005},
                                         {6, 0.1, 0.005},
                                         {6, 0.1, 0.1},
                                         {8, 1.0, 0.3},
                                         {10, 1.0, 0.1}}) {
    const Simulation world = run(column(count, size, gap), 600);
    EXPECT_NEAR(world.state(count).position.y, (count - 0.5) * size, 0.002 * count * size) << count << gap;
  }
}

TEST(WatchAlarms, AThinGroundIsAGround) {
  for (const double thickness : {0.1, 0.01, 0.001}) {
    run(column(10, 1, 0, thickness), 300);
    run(column(3, 1, 0.05, thickness), 300);
  }
}

// Whose lid touches what stands in it: the lid carries nothing.
TEST(WatchAlarms, RoomsAndCagesAreSnug) {
  Body room = box("room", {0, 0}, 4, 1);
  room.shapes[0].position = {0, -0.5};
  room.shapes.push_back(room.shapes[0]);
  room.shapes[1].position = {0, 1.5};
  const Scene pillar = with(empty_scene(), {fixed(room), box("pillar", {0, 0.5}, 0.3, 1.0001)});
  run(pillar, 1200);
  Scene ball = with(empty_scene(), {fixed(room), disc("ball", {0, 0.5}, 0.5005)});
  ball.bodies[1].velocity = {1, 0};
  run(ball, 120);
  Body cage = room;
  cage.position = {0, 1};
  cage.mass = 3, cage.inertia = 5;
  run(with(empty_scene(), {plane(), cage, box("inmate", {0, 1.5}, 1, 1.001)}), 600);
}

TEST(WatchAlarms, APebbleOnATowerIsNoTower) {
  Scene scene = column(25, 1, 0);
  const int substeps = run(scene, 60).plan().substeps;
  scene.bodies.push_back(box("pebble", {0, 25.01}, 0.02, 0.02));
  const Simulation world = run(scene, 300);
  EXPECT_GE(world.plan().substeps, substeps);
  EXPECT_LE(world.plan().substeps, substeps + 2);  // of one level more
}

// What joints take from velocities that do not fit them.
TEST(WatchAlarms, PushedPendulumsGoOn) {
  for (const Vec2d push : {Vec2d{3, 0}, Vec2d{0, 3}, Vec2d{1, 1}}) {
    Scene scene = rods(1);
    scene.bodies[0].velocity = push;
    run(scene, 300);
    Simulation world = compile(rods(3));
    world.step(20);
    BodyState state = world.state(2);
    state.velocity = push;
    world.set_state(2, state);
    EXPECT_NO_THROW(world.step(300));
  }
}

// Springs that pull against each other have energies far beyond what is in motion.
TEST(WatchAlarms, SpringsMayBePreloaded) {
  for (const double stiffness : {100.0, 1e4}) {
    for (const double off : {0.0, 1e-12, 1e-8, 1e-5}) {
      Scene scene = with(empty_scene({0, 0}), {disc("mass", {0.15 + off, 0}, 0.1)});
      for (const double end : {-1.0, 1.3})
        scene.forces.push_back(SpringForce{.body_a = std::string(kWorld),
                                           .body_b = "mass",
                                           .anchor_a = {end, 0},
                                           .rest_length = 0.3,
                                           .stiffness = stiffness});
      const Simulation world = run(scene, 600);
      EXPECT_LE(std::abs(world.state(0).position.x - 0.15), off * 1.02 + 1e-12);
      run(scene, 600, {.precision = Precision::Float});
    }
  }
}

}  // namespace
}  // namespace plumb
