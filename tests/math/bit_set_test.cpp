#include "engine/core/bit_set.h"

#include <gtest/gtest.h>

#include <random>
#include <set>
#include <vector>

namespace plumb {
namespace {

std::vector<int> members(const BitSet& bits) {
  std::vector<int> all;
  bits.for_each([&](int i) { all.push_back(i); });
  return all;
}

TEST(BitSet, AnyOperationsAgreeWithASortedSet) {
  std::mt19937 random(1);
  std::uniform_int_distribution<int> number(0, 999), choice(0, 2);
  BitSet bits;
  std::set<int> expected;
  for (int round = 0; round < 5000; ++round) {
    const int i = number(random);
    if (choice(random) > 0) {
      bits.set(i);
      expected.insert(i);
    } else {
      bits.reset(i);
      expected.erase(i);
    }
    const int j = number(random);
    EXPECT_EQ(bits.test(j), expected.count(j) > 0);
    if (round % 100 != 0) continue;
    EXPECT_EQ(bits.count(), static_cast<int>(expected.size()));
    EXPECT_EQ(members(bits), std::vector<int>(expected.begin(), expected.end()));
  }
}

TEST(BitSet, TheEdgesOfWords) {
  BitSet bits;
  const std::vector<int> edges = {0, 1, 62, 63, 64, 65, 127, 128, 4095, 4096};
  for (const int i : edges) bits.set(i);
  EXPECT_EQ(members(bits), edges);
  bits.reset(63);
  bits.reset(64);
  EXPECT_FALSE(bits.test(63) || bits.test(64));
  EXPECT_TRUE(bits.test(62) && bits.test(65));
}

TEST(BitSet, GrowsAsNeededAndKeepsItsRoom) {
  BitSet bits;
  EXPECT_EQ(bits.size(), 0);
  EXPECT_TRUE(bits.none());
  EXPECT_FALSE(bits.test(1000));
  bits.reset(1000);
  EXPECT_EQ(bits.size(), 0) << "nothing to take out";
  bits.reserve(65);
  EXPECT_EQ(bits.size(), 128);
  EXPECT_TRUE(bits.none());
  bits.set(500);
  EXPECT_GT(bits.size(), 500);
  bits.reserve(1);
  EXPECT_TRUE(bits.test(500));
  EXPECT_FALSE(bits.none());
  const int size = bits.size();
  bits.clear();
  EXPECT_EQ(bits.size(), size);
  EXPECT_EQ(bits.count(), 0);
  EXPECT_TRUE(bits.none());
}

TEST(BitSet, UnionOfDifferentSizes) {
  BitSet small, large;
  small.set(3);
  small.set(60);
  large.set(60);
  large.set(700);
  BitSet both = small;
  both |= large;
  EXPECT_EQ(members(both), (std::vector<int>{3, 60, 700}));
  large |= small;
  EXPECT_EQ(members(large), members(both));
  const BitSet& itself = both;
  both |= itself;
  EXPECT_EQ(both.count(), 3);
}

TEST(BitSet, MembersMayBeTakenOutWhileTheyAreVisited) {
  BitSet bits;
  for (int i = 0; i < 300; i += 3) bits.set(i);
  int visits = 0;
  bits.for_each([&](int i) {
    ++visits;
    bits.reset(i);
  });
  EXPECT_EQ(visits, 100);
  EXPECT_TRUE(bits.none());
}

}  // namespace
}  // namespace plumb
