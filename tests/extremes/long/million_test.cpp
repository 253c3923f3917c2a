// A million bodies. They take seconds and 2 GB.
#include <gtest/gtest.h>
#include <malloc.h>

#include <chrono>
#include <cmath>
#include <cstdio>

#include "engine/world/world.h"

namespace plumb::test {
namespace {

double heap_bytes() {
  const struct mallinfo2 info = mallinfo2();
  return static_cast<double>(info.uordblks + info.hblkhd);
}

struct Cost {
  double bytes = 0, nanoseconds = 0;  // a body; a body and step
};

// `count` squares fall apart from each other.
Cost fall(int count) {
  const double before = heap_bytes();
  World world({.sleeping = false});
  const int side = static_cast<int>(std::ceil(std::sqrt(count)));
  for (int i = 0; i < count; ++i)
    world.create_body({.position = {3.0 * (i % side), 3.0 * (i / side)}}, {.geometry = Box{1, 1}});
  const BodyId last = world.bodies().back();
  const double start = world.position(last).y;
  for (int i = 0; i < 5; ++i) world.step();
  const auto from = std::chrono::steady_clock::now();
  for (int i = 0; i < 15; ++i) world.step();
  const double time =
      std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - from).count();
  EXPECT_NEAR(world.position(last).y, start - 0.5 * 9.81 / 9, 1e-4);
  EXPECT_TRUE(world.quarantined().empty());
  return {(heap_bytes() - before) / count, time / 15 / count};
}

TEST(MillionBodies, FallForTheMemoryThatTenThousandTake) {
  const Cost few = fall(10'000), many = fall(1'000'000);
  std::printf("  10,000: %.0f B, %.0f ns a body and step; 1,000,000: %.0f B, %.0f ns\n", few.bytes,
              few.nanoseconds, many.bytes, many.nanoseconds);
  EXPECT_LT(many.bytes, 500);
  EXPECT_LT(many.bytes, 1.1 * few.bytes);
}

// Stacks of four on grounds one above the other: they stand, and fall asleep.
TEST(MillionBodies, StandInStacksAndSleep) {
  constexpr int kStoreys = 500, kColumns = 500, kHigh = 4;
  const double before = heap_bytes();
  World world;
  BodyId last;
  for (int storey = 0; storey < kStoreys; ++storey) {
    const double y = 8.0 * storey;
    for (int piece = 0; piece < kColumns / 10; ++piece)
      world.create_body({.type = BodyType::Static, .position = {20.0 * piece + 9, y - 0.5}},
                        {.geometry = Box{20, 1}});
    for (int column = 0; column < kColumns; ++column)
      for (int i = 0; i < kHigh; ++i)
        last = world.create_body({.position = {2.0 * column, y + 0.5 + i}}, {.geometry = Box{1, 1}});
  }
  const double top = world.position(last).y;
  world.step();
  const double awake = (heap_bytes() - before) / 1e6;
  for (int i = 0; i < 59; ++i) world.step();
  std::printf("  %.0f B a body awake, with its contacts; %d of 1000000 awake after 60 steps\n", awake,
              world.counts().awake);
  EXPECT_EQ(world.counts().awake, 0);
  EXPECT_EQ(world.counts().touching, 1'000'000);
  EXPECT_NEAR(world.position(last).y, top, 1e-3);
  EXPECT_LT(awake, 2500);
}

}  // namespace
}  // namespace plumb::test
