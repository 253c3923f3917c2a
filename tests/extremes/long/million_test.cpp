// A million bodies. They take seconds and 2 GB.
#include <gtest/gtest.h>
#include <malloc.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>

#include "engine/world/world.h"

namespace plumb::test {
namespace {

// The sanitizers have an allocator of their own, which mallinfo does not see, and checks in every access.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kAsShipped = false;
#else
constexpr bool kAsShipped = true;
#endif

double heap_bytes() {
  const struct mallinfo2 info = mallinfo2();
  return static_cast<double>(info.uordblks + info.hblkhd);
}

struct Cost {
  double bytes = 0, nanoseconds = 0;  // a body; a body and step, of the processor
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
  const std::clock_t from = std::clock();
  for (int i = 0; i < 15; ++i) world.step();
  const double time = 1e9 * static_cast<double>(std::clock() - from) / CLOCKS_PER_SEC;
  EXPECT_NEAR(world.position(last).y, start - 0.5 * 9.81 / 9, 1e-4);
  EXPECT_TRUE(world.quarantined().empty());
  return {(heap_bytes() - before) / count, time / 15 / count};
}

// The least time of some runs: what else the machine does only adds.
Cost least_of(int runs, int count) {
  Cost least = fall(count);
  for (int i = 1; i < runs; ++i) {
    const Cost next = fall(count);
    least.bytes = std::max(least.bytes, next.bytes);
    least.nanoseconds = std::min(least.nanoseconds, next.nanoseconds);
  }
  return least;
}

// A machine that is busy for a while has more looks.
TEST(MillionBodies, FallForWhatTenThousandTake) {
  double ratio = 1e9;
  for (int look = 0; look < (kAsShipped ? 5 : 1) && ratio >= 2; ++look) {
    const Cost few = least_of(kAsShipped ? 10 : 1, 10'000), many = least_of(kAsShipped ? 3 : 1, 1'000'000);
    std::printf("  10,000: %.0f B, %.0f ns a body and step; 1,000,000: %.0f B, %.0f ns\n", few.bytes,
                few.nanoseconds, many.bytes, many.nanoseconds);
    ratio = many.nanoseconds / few.nanoseconds;
    if (!kAsShipped)
      continue;  // that they fall, and that nothing is read or written out of place, was checked
    EXPECT_LT(many.bytes, 500);
    EXPECT_LT(many.bytes, 1.1 * few.bytes);
  }
  if (kAsShipped) {
    EXPECT_LT(ratio, 2);
  }
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
  if (kAsShipped) {
    EXPECT_LT(awake, 2500);
  }
}

}  // namespace
}  // namespace plumb::test
