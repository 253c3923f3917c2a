#include <gtest/gtest.h>

#include <map>
#include <random>

#include "engine/core/lazy_array.h"
#include "engine/core/slot_map.h"
#include "engine/world/state/corner_pool.h"
#include "tests/world/allocations.h"
#include "tests/world/support.h"

namespace plumb {
namespace {

using Corners = std::vector<Corner<float>>;

Corners corners(int kind) {
  const float x = 0.5f * static_cast<float>(kind / 3);
  Corners all;
  for (int i = 0; i <= kind % 3; ++i) all.push_back({{x, static_cast<float>(i)}, {0, 1}});
  return all;
}

TEST(CornerPool, EqualShapesShareTheirCorners) {
  CornerPool<float> pool;
  const int first = pool.add(corners(5)), other = pool.add(corners(8));
  EXPECT_NE(first, other);
  EXPECT_EQ(pool.add(corners(5)), first);
  pool.remove(first, 3);
  EXPECT_EQ(pool.run(first, 3)[2].point.y, 2);
  EXPECT_EQ(pool.add(corners(5)), first) << "there was one more use of it";
  pool.remove(first, 3), pool.remove(first, 3);
  EXPECT_EQ(pool.add(corners(11)), first) << "a run of the same length takes its place";
}

// Against a map from what runs hold to their uses; what is in use is never overwritten.
TEST(CornerPool, ComesAndGoesLikeAMap) {
  CornerPool<float> pool;
  std::mt19937 random(5);
  struct Run {
    int first = 0, uses = 0;
  };
  std::map<int, Run> runs;
  for (int i = 0; i < 20000; ++i) {
    const int kind = static_cast<int>(random() % 400);
    const Corners all = corners(kind);
    const int count = static_cast<int>(all.size());
    if (random() % 2 == 0) {
      const int first = pool.add(all);
      Run& run = runs[kind];
      if (run.uses++ == 0) run.first = first;
      ASSERT_EQ(first, run.first);
    } else if (const auto found = runs.find(kind); found != runs.end()) {
      pool.remove(found->second.first, count);
      if (--found->second.uses == 0) runs.erase(found);
    }
    if (i % 500 != 0) continue;
    for (const auto& [each, run] : runs) {
      const Corners wanted = corners(each);
      const auto held = pool.run(run.first, static_cast<int>(wanted.size()));
      for (std::size_t k = 0; k < wanted.size(); ++k) ASSERT_EQ(held[k].point, wanted[k].point);
    }
  }
}

TEST(CornerPool, UsesAreCountedAnewAfterASnapshot) {
  CornerPool<float> pool, copy;
  const int a = pool.add(corners(4)), b = pool.add(corners(5));
  pool.add(corners(4));
  copy.parts() = pool.parts();
  EXPECT_TRUE(copy.count_use(a, 2));
  EXPECT_TRUE(copy.count_use(b, 3));
  EXPECT_TRUE(copy.count_use(a, 2));
  EXPECT_FALSE(copy.count_use(b, 2)) << "an equal run begins somewhere else";
}

TEST(Room, LongListsGrowByAQuarter) {
  std::vector<int> list;
  std::size_t room = 0;
  int growths = 0;
  for (int i = 0; i < 100000; ++i) {
    append(list, i);
    EXPECT_EQ(list.back(), i);
    if (list.capacity() == room) continue;
    room = list.capacity(), ++growths;
    if (list.size() > 2 * kDoublingLimit) {
      EXPECT_LE(4 * room, 5 * list.size());
    }
  }
  EXPECT_LT(growths, 35);  // 11 doublings, then log(100000 / 1024) / log(1.25) = 20.5
}

TEST(LazyArray, HasNoRoomUntilItIsUsed) {
  LazyArray<double> list;
  list.reset(2, 3);
  EXPECT_FALSE(list.used());
  EXPECT_EQ(list.get(2), 0);
  list.at(1, 3) = 5;
  list.reset(3, 4);
  EXPECT_EQ(list.get(1), 5);
  EXPECT_EQ(list.get(3), 0);
  list.reset(1, 4);
  EXPECT_EQ(list.get(1), 0);
}

// A place that was used is clean for the next body: no name, damping, load or data stays behind.
TEST(Room, NothingIsInherited) {
  World world;
  const BodyId old = world.create_body(
      {.name = "old", .gravity_scale = 2, .linear_damping = 3, .angular_damping = 4, .user_data = 7});
  world.apply_force(old, {5, 0});
  world.destroy(old);
  const BodyId fresh = world.create_body({});
  ASSERT_EQ(fresh.index, old.index);
  EXPECT_EQ(world.name(fresh), "");
  EXPECT_EQ(world.user_data(fresh), 0u);
  world.step();
  EXPECT_EQ(world.velocity(fresh).x, 0);
  EXPECT_NEAR(world.velocity(fresh).y, -kGravity / 60, 1e-7);
}

// Bodies with a box in free flight, everything that the world holds for them included.
TEST(Room, ABodyWithABoxTakesAtMost500Bytes) {
  constexpr int kBodies = 10000;
  const long before = test::live_bytes();
  World world;
  for (int i = 0; i < kBodies; ++i) {
    world.create_body({.position = {3.0 * (i % 100), 3.0 * (i / 100)}}, {.geometry = Box{1, 1}});
  }
  for (int i = 0; i < 40; ++i) world.step();
  EXPECT_LE((test::live_bytes() - before) / kBodies, 500);
}

}  // namespace
}  // namespace plumb
