#include "engine/collision/broad_phase/pair_set.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>
#include <set>
#include <utility>

namespace plumb {
namespace {

using Pair = std::pair<int, int>;
Pair sorted(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

TEST(PairSet, AnyOperationsAgreeWithASortedSet) {
  std::mt19937 random(1);
  // From nearly always the same few pairs to hardly ever.
  for (const int range : {2, 6, 30, 1000}) {
    PairSet set;
    std::set<Pair> expected;
    const auto number = [&] { return std::uniform_int_distribution<int>(0, range - 1)(random); };
    for (int round = 0; round < 20000; ++round) {
      const int a = number(), other = number(), b = other != a ? other : (a + 1) % range;
      // More inserting than erasing at first, then the other way round.
      if (number() % 3 != (round < 12000 ? 0 : 1) && number() % 2 == (round < 12000))
        EXPECT_EQ(set.insert(a, b), expected.insert(sorted(a, b)).second);
      else
        EXPECT_EQ(set.erase(a, b), expected.erase(sorted(a, b)) > 0);
      EXPECT_EQ(set.size(), static_cast<int>(expected.size()));
      const int c = number(), d = number();
      EXPECT_EQ(set.contains(c, d), expected.count(sorted(c, d)) > 0);
    }
    for (const auto& [a, b] : expected) EXPECT_TRUE(set.contains(b, a));
    set.clear();
    EXPECT_EQ(set.size(), 0);
    for (const auto& [a, b] : expected) EXPECT_FALSE(set.contains(a, b));
  }
}

TEST(PairSet, TheWholeRange) {
  constexpr int kMax = std::numeric_limits<int>::max();
  PairSet set;
  EXPECT_FALSE(set.contains(0, 1));
  EXPECT_FALSE(set.erase(0, 1));
  for (const auto& [a, b] : {Pair{0, 1}, {kMax, 0}, {kMax, 1}, {kMax - 1, kMax}}) {
    EXPECT_TRUE(set.insert(a, b));
    EXPECT_FALSE(set.insert(b, a));
    EXPECT_TRUE(set.contains(b, a));
  }
  EXPECT_EQ(set.size(), 4);
}

// With linear probing at load L, a hash without structure needs (1 + 1/(1 - L)) / 2 probes for a pair that is
// there (Knuth 6.4): 1.5 at one half. Pairs of neighbours are what a world has.
TEST(PairSet, PairsOfNeighboursDoNotCrowd) {
  constexpr int kSide = 128;
  const auto cell = [](int x, int y) { return y * kSide + x; };
  PairSet grid, row, star;
  for (int y = 0; y + 1 < kSide; ++y)
    for (int x = 0; x + 1 < kSide; ++x) {
      grid.insert(cell(x, y), cell(x + 1, y));
      grid.insert(cell(x, y), cell(x, y + 1));
    }
  for (int i = 0; i < 32768; ++i) {
    row.insert(i, i + 1);
    star.insert(0, i + 1);
  }
  for (const PairSet* each : {&grid, &row, &star}) {
    EXPECT_LT(each->mean_probes(), 1.55);
    EXPECT_GT(each->mean_probes(), 1.2);
  }
}

TEST(PairSet, RoomIsKept) {
  PairSet set;
  set.reserve(1000);
  const int room = set.capacity();
  for (int i = 0; i < 1000; ++i) set.insert(i, i + 1);
  EXPECT_EQ(set.capacity(), room);
  for (int i = 0; i < 100000; ++i) {
    set.erase(i, i + 1);
    set.insert(i + 1000, i + 1001);
  }
  EXPECT_EQ(set.capacity(), room) << "erased pairs leave nothing behind";
  EXPECT_LT(set.mean_probes(), 1.7) << "1000 pairs scatter more about 1.5 than many";
}

}  // namespace
}  // namespace plumb
