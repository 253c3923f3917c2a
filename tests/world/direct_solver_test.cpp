#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <vector>

#include "engine/world/world_data.h"
#include "tests/world/solver_scenes.h"

// Checks what is particular to the direct solution: joined bodies do not stretch their joints.
namespace plumb {
namespace {

using test::with;

// A drift of h^2 v^2 / 2 a substep is closed by Newton steps, to what a float rounds: positions are kept in
// double, differences of ten rods are not. Measured 2e-7 to 1.3e-6 m; soft steps have 4e-4 to 3e-2.
TEST(Direct, SwingingChainsDoNotStretch) {
  for (const int count : {2, 10, 100}) {
    for (const double tip : {1.0, 100.0}) {
      World world(with(Solver::Direct));
      const test::Chain chain = test::add_chain(world, count, tip);
      EXPECT_LT(test::run_gap(world, chain.joints, 180), 4e-6) << count << ' ' << tip;
    }
  }
}

// A bridge, which is no tree: rods in a zigzag between two hooks. It swings through, and snaps taut: 2.4e-5
// m.
TEST(Direct, SwingingBridgesDoNotStretch) {
  World world(with(Solver::Direct));
  BodyId before = test::add_hook(world);
  std::vector<JointId> joints;
  Vec2d at{};
  for (int i = 0; i < 20; ++i) {
    const double angle = i % 2 == 0 ? 0.5 : -0.5;
    const Vec2d half{0.5 * std::cos(angle), 0.5 * std::sin(angle)};
    const BodyId rod = test::add_mass(world, at + half, 1, 1.0 / 12);
    world.set_position(rod, at + half, angle);
    joints.push_back(world.create_joint(
        before, rod, {.kind = RevoluteDefinition{.anchor_a = {i == 0 ? 0 : 0.5, 0}, .anchor_b = {-0.5, 0}}}));
    at += 2.0 * half, before = rod;
  }
  joints.push_back(world.create_joint(before, test::add_hook(world, at),
                                      {.kind = RevoluteDefinition{.anchor_a = {0.5, 0}}}));
  EXPECT_LT(test::run_gap(world, joints, 180), 7e-5);
}

// Taut rods of m under a tension T swing across at up to sqrt(12 T / (m L)) and more: at 1:1000 a substep
// must be shorter than 1/240 s.
TEST(Direct, ATipOfAThousandNeedsEightSubsteps) {
  World world(with(Solver::Direct));
  const test::Chain chain = test::add_chain(world, 10, 1000);
  EXPECT_LT(test::run_gap(world, chain.joints, 180, 1.0 / 60, 8), 4e-6);
}

// Equal masses: soft steps leave them to the sweeps, whether small islands are solved directly or not.
TEST(Direct, HoldsBetterThanSoftSteps) {
  World soft(with(Solver::SoftSteps)), direct(with(Solver::Direct));
  const test::Chain a = test::add_chain(soft, 16), b = test::add_chain(direct, 16);
  EXPECT_GT(test::run_gap(soft, a.joints, 60), 100 * test::run_gap(direct, b.joints, 60));
}

TEST(Direct, SoftStepsMayGoWithoutIt) {
  double gap[2];
  for (const bool on : {false, true}) {
    WorldDefinition definition = with(Solver::SoftSteps);
    definition.direct_islands = on;
    World world(definition);
    const test::Chain chain = test::add_chain(world, 10, 1000);
    run(world, 30);
    gap[on ? 1 : 0] = test::worst_gap(world, chain.joints);
  }
  EXPECT_LT(gap[1], 0.01);
  EXPECT_GT(gap[0], 10 * gap[1]);
  World world(with(Solver::SoftSteps));
  const test::Chain chain = test::add_chain(world, 10, 1000);
  world.set_direct_islands(false);
  run(world, 30);
  EXPECT_EQ(test::worst_gap(world, chain.joints), gap[0]);
}

// A joint that is open across a locked axis stays open: closing it moves what may move alone.
TEST(Direct, ClosingJointsMovesNothingAlongLockedAxes) {
  for (const bool along_x : {false, true}) {
    World world(with(Solver::Direct));
    const BodyId anchor = world.create_body({.type = BodyType::Static});
    const BodyId slider =
        world.create_body({.position = {1, 0.2}, .velocity = {1, 1}, .lock_x = along_x, .lock_y = !along_x},
                          {.geometry = Box{1, 0.2}});
    world.create_joint(anchor, slider,
                       {.kind = RevoluteDefinition{.anchor_a = {0.7, -0.1}, .anchor_b = {-0.5, 0}}});
    for (int i = 0; i < 30; ++i) {
      world.step();
      EXPECT_EQ(along_x ? world.centre(slider).x : world.centre(slider).y, along_x ? 1 : 0.2) << i;
    }
  }
}

// 300 rows, each one tied to all others: too costly to solve directly, so it is as without the direct
// solution. (A limit, far away: it is no tree of plain hinges.)
TEST(Direct, AWheelOfSpokesIsLeftToTheSweeps) {
  std::uint64_t hashes[2];
  for (const bool on : {false, true}) {
    WorldDefinition definition = with(Solver::SoftSteps);
    definition.direct_islands = on;
    World world(definition);
    const BodyId hub = add_box(world, {0, 0}, 100);
    for (int i = 0; i < 150; ++i) {
      const BodyId spoke = add_box(world, {2.0 + i, 0}, 1, 0.5, 0.5);
      world.create_joint(
          hub, spoke,
          {.kind = RevoluteDefinition{.anchor_a = {1.0 + i, 0},
                                      .anchor_b = {-1, 0},
                                      .limits = i == 0 ? std::optional(Range{-9, 9}) : std::nullopt}});
    }
    run(world, 20);
    hashes[on ? 1 : 0] = world.hash();
  }
  EXPECT_EQ(hashes[0], hashes[1]);
}

// A body cannot be pushed out of two walls at once. Solved as they stand, the contradicting rows ask for
// impulses of up to 1e9 N s; sweeps stop at 3 to 92 N s.
TEST(Direct, WallsTooCloseDoNotSqueezeWithoutBound) {
  for (const double width : {0.99, 0.9, 0.7}) {
    for (const ShapeGeometry& geometry : {ShapeGeometry{Circle{0.5}}, ShapeGeometry{Box{1, 1}}}) {
      World world(with(Solver::SoftSteps));
      const BodyId walls = world.create_body({.type = BodyType::Static});
      world.create_shape(walls, {.geometry = Box{1, 4}, .position = {-0.5 - width / 2, 0}});
      world.create_shape(walls, {.geometry = Box{1, 4}, .position = {0.5 + width / 2, 0}});
      world.create_shape(walls, {.geometry = Box{4, 1}, .position = {0, -1}});
      world.create_body({}, {.geometry = geometry});
      double largest = 0;
      for (int i = 0; i < 60; ++i) {
        world.step(1.0 / 60, 4);
        world.data().graph.for_each([&](const auto& contact) {
          for (int k = 0; k < contact.count; ++k)
            largest = std::fmax(largest, static_cast<double>(contact.normal_impulse[k]));
        });
      }
      EXPECT_LT(largest, 200) << width;
    }
  }
}

// Joints and contacts in one: a chain that lies over a box.
TEST(Direct, ChainsLieOnBodies) {
  World world(with(Solver::Direct));
  add_ground(world);
  add_box(world, {0, 0.5});
  std::vector<JointId> joints;
  BodyId before{};
  for (int i = 0; i < 12; ++i) {
    const BodyId link = add_box(world, {-2.75 + 0.5 * i, 1.5}, 1, 0.5, 0.2);
    if (i > 0) {
      joints.push_back(world.create_joint(
          before, link, {.kind = RevoluteDefinition{.anchor_a = {0.25, 0}, .anchor_b = {-0.25, 0}}}));
    }
    before = link;
  }
  EXPECT_LT(test::run_gap(world, joints, 600), 1e-3);
  for (const BodyId body : world.bodies()) {
    EXPECT_GT(world.position(body).y, -0.01);
    EXPECT_LT(std::sqrt(length_squared(world.velocity(body))), 0.05);
  }
}

// 15 x 15 discs in a net that hangs by its corners: a factorisation would cost too much, and sweeps hold it.
TEST(DirectSolver, WhatCostsTooMuchIsSwept) {
  World world({.sleeping = false, .solver = Solver::Direct});
  constexpr int kSide = 15;
  std::vector<BodyId> discs;
  for (int i = 0; i < kSide * kSide; ++i) {
    const bool held = i == 0 || i == kSide - 1;
    const Vec2d at{1.0 * (i % kSide), -1.0 * (i / kSide)};
    discs.push_back(world.create_body({.type = held ? BodyType::Static : BodyType::Dynamic, .position = at},
                                      {.geometry = Circle{0.4}}));
    const auto join = [&](int other, Vec2d half) {
      world.create_joint(discs[other], discs[i],
                         {.kind = RevoluteDefinition{.anchor_a = half, .anchor_b = -half}});
    };
    if (i % kSide > 0) join(i - 1, {0.5, 0});
    if (i >= kSide) join(i - kSide, {0, -0.5});
  }
  run(world, 60);
  for (const BodyId disc : discs) EXPECT_GT(world.position(disc).y, -3.0 * kSide);
}

}  // namespace
}  // namespace plumb
