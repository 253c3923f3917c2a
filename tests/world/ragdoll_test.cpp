#include "tests/world/ragdoll.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "tests/world/support.h"

namespace plumb {
namespace {

constexpr double kDegree = 3.14159265358979324 / 180;

// rad, how far a joint of the torso is beyond its limits.
double past_limits(const World& world, BodyId torso) {
  double worst = 0;
  for (const JointId joint : world.joints(torso)) {
    const Range limits = *std::get<RevoluteDefinition>(world.kind(joint)).limits;
    const double angle = world.read(joint).angle;
    worst = std::max({worst, limits.lower - angle, angle - limits.upper});
  }
  return worst;
}

void add_heap(World& world) {
  add_ground(world);
  for (int i = 0; i < 20; ++i) add_box(world, {-2 + 0.9 * (i % 5), 0.4 + 0.8 * (i / 5)}, 1, 0.7, 0.7);
}

// rad, the largest overshoot of a ragdoll that falls onto a heap of boxes.
double drop(World& world, const RagdollStart& start, int substeps, int steps) {
  const BodyId torso = add_ragdoll(world, start)[0];
  double worst = 0;
  for (int i = 0; i < steps; ++i) {
    world.step(1.0 / 60, substeps);
    worst = std::max(worst, past_limits(world, torso));
  }
  return worst;
}

// However it comes down: from 3, 6, 10 and 15 m above the heap, at up to 17 m/s, in any attitude. Limits are
// projected to 0.57 degrees; closing the gaps of the joints turns no limb past a limit.
TEST(Ragdoll, OvershootsItsLimitsByLessThanOneDegree) {
  for (const double height : {3.0, 6.0, 10.0, 15.0}) {
    for (int i = 0; i < 12; ++i) {
      World world;
      add_heap(world);
      const RagdollStart start{.at = {-0.8 + 0.15 * i, 4 + height},
                               .tilt = i * 30 * kDegree,
                               .velocity = {2 - 0.4 * i, 0},
                               .spin = (i * 5) % 12 - 5.0};
      EXPECT_LT(drop(world, start, 4, 240), kDegree) << height << " m, attitude " << i;
    }
  }
}

TEST(Ragdoll, TwoSubstepsHoldItsLimitsToo) {
  for (int i = 0; i < 12; ++i) {
    World world;
    add_heap(world);
    EXPECT_LT(drop(world, {.at = {0, 10}, .tilt = i * 30 * kDegree}, 2, 240), 2 * kDegree) << i;
  }
}

// A figure of a torso and nine limbs, 2.55 sizes high, that drops from 4 sizes.
BodyId add_figure(World& world, double size, double tilt) {
  const Vec2d up{0, 4 * size};
  const Rotation<double> q = rotation_of(tilt);
  const auto part = [&](Vec2d centre, double width, double height) {
    return world.create_body({.position = up + q * (size * centre), .angle = tilt},
                             {.geometry = Box{width * size, height * size}, .density = 100});
  };
  const auto join = [&](BodyId a, BodyId b, Vec2d at, Range limits) {
    const Vec2d anchor = up + q * (size * at);
    world.create_joint(a, b,
                       {.kind = RevoluteDefinition{.anchor_a = world.local_point(a, anchor),
                                                   .anchor_b = world.local_point(b, anchor),
                                                   .limits = limits}});
    return b;
  };
  const BodyId torso = part({0, 0}, 0.4, 0.8);
  join(torso, part({0, 0.6}, 0.3, 0.3), {0, 0.4}, {-0.5, 0.5});
  for (const double side : {-1.0, 1.0}) {
    const auto one_side = [&](double low, double high) {
      return side < 0 ? Range{low, high} : Range{-high, -low};
    };
    const BodyId arm =
        join(torso, part({0.5 * side, 0.3}, 0.6, 0.15), {0.2 * side, 0.3}, one_side(-1.5, 1.5));
    join(arm, part({1.1 * side, 0.3}, 0.6, 0.12), {0.8 * side, 0.3}, one_side(-2, 0.1));
    const BodyId leg =
        join(torso, part({0.15 * side, -0.8}, 0.2, 0.8), {0.15 * side, -0.4}, one_side(-1, 0.6));
    join(leg, part({0.15 * side, -1.5}, 0.18, 0.6), {0.15 * side, -1.2}, one_side(-2, 0.1));
  }
  return torso;
}

// The right distance is 0. When its joints were closed in each step without the friction of the floor, it
// crept in 20 s by 0.28 sizes in the mean of 96 drops, and by 3.6 at most; now by 0.03 and 0.34, the small
// figures most.
TEST(Ragdoll, LiesOnAFloorAndHardlyCreeps) {
  double sum = 0;
  int count = 0;
  for (const double size : {0.2, 0.4, 0.8}) {
    for (int i = 0; i < 12; ++i) {
      World world;
      add_ground(world);
      const BodyId torso = add_figure(world, size, 1.1 * i);
      run(world, 1200);
      const double before = world.position(torso).x;
      run(world, 1200);
      const double moved = std::abs(world.position(torso).x - before) / size;
      EXPECT_LT(moved, 0.4) << size << " m, turned by " << 1.1 * i;
      sum += moved, ++count;
    }
  }
  EXPECT_LT(sum / count, 0.04);
}

TEST(Ragdoll, SettlesOnAHeapAndSleeps) {
  World world;
  add_heap(world);
  drop(world, {.at = {0, 6}}, 4, 1200);
  EXPECT_EQ(world.counts().awake, 0);
}

// Limbs wedged in each other press joints against contacts; what is solved directly must not make much of it.
// They come apart no faster than overlaps of half a limb are pushed out at. Where two limbs catch each other
// is chance: one start in 200 flings one faster (of 3,000 other starts 12 to 26, with each of five values of
// kLoadEstimateOverlap from 0.0015 to 0.0025), so that the bound is for all but one in 25.
TEST(Ragdoll, TwoThatBeginInsideEachOtherComeApart) {
  const char* more = std::getenv("PLUMB_PROPERTY_CASES");
  const int starts = 25 * (more != nullptr ? std::max(std::atoi(more), 1) : 1);
  std::vector<double> fastest;
  for (int start = 0; start < starts; ++start) {
    const double apart = 0.5 * start / starts;
    World world;
    add_ground(world);
    add_ragdoll(world, {.at = {0, 2}, .head_density = 40});
    add_ragdoll(world, {.at = {apart, 2}, .tilt = 20 * kDegree, .group = -2});
    fastest.push_back(0);
    ASSERT_NO_THROW(for (int i = 0; i < 300; ++i) {
      world.step(1.0 / 30, 1 + i % 4);
      for (const BodyId body : world.bodies())
        fastest.back() = std::max(fastest.back(), std::sqrt(length_squared(world.velocity(body))));
    }) << apart
       << " m apart";
  }
  std::sort(fastest.begin(), fastest.end());
  EXPECT_LT(fastest[fastest.size() / 2], 6);
  EXPECT_LT(fastest[fastest.size() * 96 / 100 - 1], 15);
}

// An angle that starts far beyond its limits comes back within a second, without a burst, and about the
// joint.
TEST(Ragdoll, WhatIsPlacedBeyondALimitComesBackGently) {
  World world(weightless());
  const BodyId a = add_box(world, {0, 0}), b = add_box(world, {1, 0});
  const JointId joint = world.create_joint(
      a, b,
      {.kind = RevoluteDefinition{.anchor_a = {0.5, 0}, .anchor_b = {-0.5, 0}, .limits = Range{1.0, 2.0}}});
  double gap = 0;
  for (int i = 0; i < 12; ++i) {
    world.step();
    gap = std::max(gap, world.read(joint).linear_error);
  }
  EXPECT_GT(world.read(joint).angle, 1 - 0.6 * kDegree);
  EXPECT_LT(gap, 0.01);
  // Nobody pushes from outside: the centre of mass stays where it was.
  EXPECT_NEAR(world.centre(a).x + world.centre(b).x, 1, 1e-5);
  EXPECT_NEAR(world.centre(a).y + world.centre(b).y, 0, 1e-5);
}

}  // namespace
}  // namespace plumb
