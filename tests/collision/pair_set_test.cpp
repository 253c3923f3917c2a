#include "engine/collision/broad_phase/pair_set.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "engine/scene/error.h"

namespace plumb {
namespace {

using Pair = std::pair<int, int>;
Pair sorted(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

std::vector<std::byte> bytes_of(const PairSet& set) {
  std::vector<std::byte> bytes;
  set.save(bytes);
  return bytes;
}

TEST(PairSet, AnyOperationsAgreeWithASortedSet) {
  std::mt19937 random(1);
  // From nearly always the same few pairs to hardly ever.
  for (const int range : {2, 6, 30, 1000}) {
    PairSet set;
    std::set<Pair> expected;
    const auto number = [&] { return std::uniform_int_distribution<int>(0, range - 1)(random); };
    for (int round = 0; round < 20000; ++round) {
      const int a = number(), b = number();
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
  EXPECT_FALSE(set.contains(0, 0));
  EXPECT_FALSE(set.erase(0, 0));
  for (const auto& [a, b] : {Pair{0, 0}, {kMax, 0}, {kMax, kMax}, {kMax - 1, kMax}}) {
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
    star.insert(0, i);
  }
  for (const PairSet* each : {&grid, &row, &star}) {
    EXPECT_LT(each->mean_probes(), 1.55);
    EXPECT_GT(each->mean_probes(), 1.2);
  }
}

TEST(PairSet, RoomIsKept) {
  PairSet set;
  set.reserve(1000);
  const std::size_t room = bytes_of(set).size();
  for (int i = 0; i < 1000; ++i) set.insert(i, i + 1);
  EXPECT_EQ(bytes_of(set).size(), room);
  for (int i = 0; i < 100000; ++i) {
    set.erase(i, i + 1);
    set.insert(i + 1000, i + 1001);
  }
  EXPECT_EQ(bytes_of(set).size(), room) << "erased pairs leave nothing behind";
  EXPECT_LT(set.mean_probes(), 1.7) << "1000 pairs scatter more about 1.5 than many";
}

TEST(PairSet, ASnapshotIsTheSameSet) {
  PairSet set;
  for (int i = 0; i < 300; ++i) set.insert(i * 7 % 100, i * 11 % 90);
  PairSet copy;
  copy.insert(1, 2);
  std::vector<std::byte> bytes = bytes_of(set);
  bytes.push_back(std::byte{42});
  std::span<const std::byte> in(bytes);
  copy.restore(in);
  EXPECT_EQ(in.size(), 1u) << "what follows is left";
  EXPECT_EQ(copy.size(), set.size());
  for (int i = 0; i < 1000; ++i) {
    EXPECT_EQ(copy.insert(i % 100, i % 90), set.insert(i % 100, i % 90));
    EXPECT_EQ(copy.erase(i % 80, i % 70), set.erase(i % 80, i % 70));
  }
  EXPECT_EQ(bytes_of(copy), bytes_of(set));
  PairSet none;
  bytes = bytes_of(none);
  in = bytes;
  copy.restore(in);
  EXPECT_EQ(copy.size(), 0);
  EXPECT_FALSE(copy.contains(1, 2));
}

// Any single bit changed moves a key from its place, adds one or loses one.
TEST(PairSet, DamagedSnapshotsAreRefused) {
  PairSet set;
  for (int i = 0; i < 6; ++i) set.insert(i, 2 * i + 1);
  const std::vector<std::byte> good = bytes_of(set);
  PairSet target;
  target.insert(8, 9);
  for (std::size_t size = 0; size < good.size(); ++size) {
    std::span<const std::byte> cut(good.data(), size);
    EXPECT_THROW(target.restore(cut), Error) << size;
  }
  for (std::size_t at = 0; at < good.size(); ++at)
    for (int bit = 0; bit < 8; ++bit) {
      std::vector<std::byte> bad = good;
      bad[at] ^= static_cast<std::byte>(1 << bit);
      std::span<const std::byte> in(bad);
      PairSet result;
      try {
        result.restore(in);
        // Another pair with its home in the same place.
        EXPECT_EQ(result.size(), 6);
      } catch (const Error& error) {
        EXPECT_EQ(error.kind(), Error::Kind::Value);
        EXPECT_EQ(error.subject(), "snapshot");
        EXPECT_THROW(target.restore(in), Error);
      }
    }
  EXPECT_EQ(target.size(), 1);
  EXPECT_TRUE(target.contains(8, 9));
}

}  // namespace
}  // namespace plumb
