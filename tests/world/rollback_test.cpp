#include "engine/world/rollback.h"

#include <gtest/gtest.h>

#include <map>

#include "engine/scene/error.h"
#include "engine/world/snapshot.h"
#include "engine/world/state_hash.h"
#include "tests/world/allocations.h"
#include "tests/world/busy_world.h"

namespace plumb {
namespace {

using test::BusyWorld;
using test::Handles;
using test::make_busy_world;
using test::run;

template <class Real>
class RollbackTest : public testing::Test {};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(RollbackTest, Precisions);

// 300 steps of a falling pile with joints while bodies come and go; at each of several points the last 8
// steps are taken back and done again: the same bits in every step, contacts and trees included.
TYPED_TEST(RollbackTest, EightStepsBackGiveTheSameBits) {
  BusyWorld<TypeParam> busy = make_busy_world<TypeParam>();
  Rollback<TypeParam> rollback(busy.world, 9);
  std::map<std::int64_t, std::uint64_t> hashes;
  std::map<std::int64_t, Handles> handles;
  const auto advance = [&](int steps) {
    for (int i = 0; i < steps; ++i) {
      rollback.save();
      const std::int64_t step = busy.world.step_count();
      const std::uint64_t hash = full_hash(busy.world);
      const auto [known, is_new] = hashes.try_emplace(step, hash);
      ASSERT_EQ(known->second, hash) << "step " << step;
      handles[step] = busy.handles();
      run(busy, 1);
    }
  };
  while (busy.world.step_count() < 300) {
    advance(20);
    const std::int64_t back = busy.world.step_count() - 8;
    rollback.back_to(back);
    busy.handles() = handles[back];
    EXPECT_EQ(busy.world.step_count(), back);
    EXPECT_EQ(rollback.latest(), back);
    advance(8);
  }
  // The same as a world that was never taken back.
  BusyWorld<TypeParam> straight = make_busy_world<TypeParam>();
  run(straight, static_cast<int>(busy.world.step_count()));
  EXPECT_EQ(full_hash(straight.world), full_hash(busy.world));
}

TYPED_TEST(RollbackTest, OtherInputsGiveAnotherResult) {
  BusyWorld<TypeParam> busy = make_busy_world<TypeParam>();
  Rollback<TypeParam> rollback(busy.world, 4);
  run(busy, 150);
  rollback.save();
  const std::int64_t step = busy.world.step_count();
  const Handles handles = busy.handles();
  run(busy, 8);
  const std::uint64_t before = busy.world.hash();
  rollback.back_to(step);
  busy.handles() = handles;
  busy.world.apply_impulse(busy.links[5], {0.01, 0});
  run(busy, 8);
  EXPECT_NE(busy.world.hash(), before);
  rollback.back_to(step);
  busy.handles() = handles;
  run(busy, 8);
  EXPECT_EQ(busy.world.hash(), before);
}

// A state in the ring and a snapshot are the same state.
TYPED_TEST(RollbackTest, AgreesWithSnapshots) {
  BusyWorld<TypeParam> busy = make_busy_world<TypeParam>();
  Rollback<TypeParam> rollback(busy.world, 2);
  run(busy, 90);
  rollback.save();
  const std::vector<std::byte> bytes = save(busy.world);
  run(busy, 30);
  rollback.back_to(90);
  EXPECT_EQ(save(busy.world), bytes);
}

TEST(RollbackRing, KeepsTheLatest) {
  World world;
  Rollback<float> rollback(world, 3);
  EXPECT_EQ(rollback.latest(), -1);
  EXPECT_THROW(rollback.back_to(0), Error);
  for (int i = 0; i < 5; ++i) {
    rollback.save();
    world.step();
  }
  EXPECT_EQ(rollback.oldest(), 2);
  EXPECT_EQ(rollback.latest(), 4);
  EXPECT_FALSE(rollback.holds(1));
  EXPECT_FALSE(rollback.holds(5));
  EXPECT_THROW(rollback.back_to(5), Error);
  EXPECT_EQ(world.step_count(), 5);
  rollback.back_to(3);
  EXPECT_EQ(rollback.size(), 2);
  // Saved again: the one of the same step gives way.
  rollback.save();
  EXPECT_EQ(rollback.size(), 2);
  rollback.back_to(2);
  EXPECT_EQ(world.step_count(), 2);
  EXPECT_DOUBLE_EQ(world.time(), 2.0 / 60);
}

TEST(RollbackRing, RefusesNoFrames) {
  World world;
  EXPECT_THROW(Rollback<float>(world, 0), Error);
  EXPECT_THROW(Rollback<float>(world, -3), Error);
  EXPECT_THROW(Rollback<float>(world, 100000), Error);
}

// The same eight steps of a falling pile again and again, with their savings in the ring and as bytes. The
// first times make the room that is needed.
TYPED_TEST(RollbackTest, AllocatesNothingAfterWarmUp) {
  BusyWorld<TypeParam> busy = make_busy_world<TypeParam>();
  Rollback<TypeParam> rollback(busy.world, 9);
  std::vector<std::byte> bytes;
  const auto forth = [&](int steps) {
    for (int i = 0; i < steps; ++i) {
      rollback.save();
      save(busy.world, bytes);
      busy.world.step();
    }
  };
  forth(150);
  const std::int64_t start = rollback.latest();
  const auto round = [&] {
    rollback.back_to(start);
    forth(8);
  };
  for (int i = 0; i < 3; ++i) round();
  const long before = test::allocations();
  ASSERT_GT(before, 0);
  for (int i = 0; i < 20; ++i) round();
  EXPECT_EQ(test::allocations() - before, 0);
}

}  // namespace
}  // namespace plumb
