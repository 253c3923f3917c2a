#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "tests/world/allocations.h"
#include "tests/world/ragdoll.h"
#include "tests/world/support.h"

namespace plumb {
namespace {

// A drum of 24 segments in which a bar turns: islands join and part all the time.
World make_stirred(int count) {
  World world({.sleeping = false});
  const BodyId drum = world.create_body({.type = BodyType::Static});
  const auto point = [](int i) {
    const double angle = 2 * std::numbers::pi * i / 24;
    return Vec2d{6 * std::cos(angle), 6 * std::sin(angle)};
  };
  for (int i = 0; i < 24; ++i) world.create_shape(drum, {.geometry = Segment{point(i), point(i + 1)}});
  world.create_body({.type = BodyType::Kinematic, .angular_velocity = 1.5},
                    ShapeDefinition{.geometry = Box{10.4, 0.3}});
  const ShapeGeometry kinds[] = {Box{0.4, 0.4}, Circle{0.2}, Capsule{{-0.1, 0}, {0.1, 0}, 0.15}};
  for (int i = 0; i < count; ++i) {
    const double column = i % 15, row = i / 15;
    world.create_body({.position = {-3.5 + 0.5 * column, 0.5 + 0.45 * row}},
                      ShapeDefinition{.geometry = kinds[i % 3], .material = {.restitution = 0.2}});
  }
  return world;
}

// If islands come and go without end, something may still become more than ever before, a time or two. Each
// island with room of its own asked for it 11 times here.
TEST(Churn, StepsHardlyEverAllocateOnceWarm) {
  World world = make_stirred(120);
  run(world, 6000);
  int begun = 0;
  const long before = test::allocations();
  for (int i = 0; i < 600; ++i) {
    world.step();
    begun += static_cast<int>(world.events().begin.size());
  }
  EXPECT_LE(test::allocations() - before, 3);
  EXPECT_GT(begun, 600) << "otherwise nothing is stirred";
}

// Each group of ragdolls is taken away when its turn comes again, as in the field's rain. Creating bodies may
// allocate, steps may not, once the lists are as long as they become.
TEST(Churn, StepsOfRagdollsThatComeAndGoDoNotAllocate) {
  constexpr int kGroups = 6, kEvery = 8, kCycle = kGroups * kEvery;
  World world({.sleeping = false});
  world.create_body({.type = BodyType::Static}, ShapeDefinition{.geometry = Box{40, 1}});
  std::vector<BodyId> groups[kGroups];
  long of_steps = 0;
  for (int step = 0; step < 12 * kCycle; ++step) {
    if (step % kEvery == 0) {
      std::vector<BodyId>& group = groups[step / kEvery % kGroups];
      for (const BodyId body : group) world.destroy(body);
      group.clear();
      for (int i = 0; i < 3; ++i) {
        const Vec2d at{-12 + 4.0 * (step / kEvery % kGroups) + i, 6.0 + 2 * i};
        const std::vector<BodyId> parts = add_ragdoll(world, {.at = at, .group = -(i + 1)});
        group.insert(group.end(), parts.begin(), parts.end());
      }
    }
    const long before = test::allocations();
    world.step();
    if (step >= 8 * kCycle) of_steps += test::allocations() - before;
  }
  EXPECT_EQ(of_steps, 0);
}

}  // namespace
}  // namespace plumb
