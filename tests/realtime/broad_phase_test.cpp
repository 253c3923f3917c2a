#include "engine/realtime/broad_phase.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

namespace plumb {
namespace {

Aabb<double> square(double x, double y, double half) { return {{x - half, y - half}, {x + half, y + half}}; }

TEST(AabbTree, QueriesAgreeWithLookingAtAll) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(0, 100);
  constexpr int kLeaves = 500;
  AabbTree<double> tree(kLeaves);
  std::vector<Aabb<double>> boxes(kLeaves);
  for (int round = 0; round < 2000; ++round) {
    const int leaf = round % kLeaves;
    boxes[leaf] = square(uniform(random), uniform(random), 0.2 + 0.02 * uniform(random));
    tree.place(leaf, boxes[leaf]);
    if (round < kLeaves || round % 50 != 0) continue;
    ASSERT_TRUE(tree.valid());
    const Aabb<double> window = square(uniform(random), uniform(random), 5);
    std::set<int> found, expected;
    tree.query(window, [&](int other) { found.insert(other); });
    for (int i = 0; i < kLeaves; ++i)
      if (boxes[i].overlaps(window)) expected.insert(i);
    EXPECT_EQ(found, expected);
  }
}

// Boxes in a row, inserted in order: the worst case for a tree without rotations, whose height would be 1000.
TEST(AabbTree, StaysLowForARow) {
  constexpr int kLeaves = 1000;
  AabbTree<double> tree(kLeaves);
  for (int i = 0; i < kLeaves; ++i) tree.place(i, square(i, 0, 0.4));
  EXPECT_LT(tree.height(), 3 * std::log2(kLeaves));
}

TEST(AabbTree, EmptyAndSingle) {
  AabbTree<float> none(0);
  none.query({{0, 0}, {1, 1}}, [](int) { FAIL(); });
  AabbTree<float> one(1);
  one.place(0, {{0, 0}, {1, 1}});
  one.place(0, {{2, 2}, {3, 3}});
  int hits = 0;
  one.query({{2, 2}, {2, 2}}, [&](int) { ++hits; });
  EXPECT_EQ(hits, 1);
  EXPECT_EQ(one.height(), 1);
}

TEST(BroadPhase, KeepsExactlyTheOverlappingPairs) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  constexpr int kShapes = 120;
  BroadPhase<double> broad(kShapes);
  std::vector<Vec2d> centers(kShapes);
  for (Vec2d& center : centers) center = {10 * uniform(random), 10 * uniform(random)};
  std::set<PairKey> pairs;
  std::vector<PairKey> found;
  const auto odd_with_all = [](int a, int b) { return (a + b) % 2 == 1; };
  for (int step = 0; step < 100; ++step) {
    for (int i = 0; i < kShapes; ++i) {
      centers[i] += Vec2d{0.2 * uniform(random), 0.2 * uniform(random)};
      broad.place(i, square(centers[i].x, centers[i].y, 0.5), 0.1);
    }
    found.clear();
    broad.search(odd_with_all, found);
    EXPECT_TRUE(std::is_sorted(found.begin(), found.end()));
    EXPECT_EQ(std::adjacent_find(found.begin(), found.end()), found.end());
    pairs.insert(found.begin(), found.end());
    std::erase_if(pairs, [&](PairKey pair) { return !broad.overlap(pair); });
    for (int i = 0; i < kShapes; ++i)
      for (int j = i + 1; j < kShapes; ++j) {
        const bool kept = pairs.count(pair_key(i, j)) > 0;
        EXPECT_EQ(kept, odd_with_all(i, j) && broad.box(i).overlaps(broad.box(j)));
      }
  }
}

TEST(BroadPhase, SmallMotionsChangeNothingAndLargeBoxesShrink) {
  BroadPhase<double> broad(1);
  EXPECT_TRUE(broad.place(0, square(0, 0, 1), 0.1));
  EXPECT_FALSE(broad.place(0, square(0.05, -0.05, 1), 0.1));
  EXPECT_TRUE(broad.place(0, square(0.2, 0, 1), 0.1));
  EXPECT_TRUE(broad.place(0, {{-1, -1}, {100, 1}}, 0.1)) << "a fast motion";
  EXPECT_TRUE(broad.place(0, square(50, 0, 1), 0.1)) << "is forgotten once it is over";
}

}  // namespace
}  // namespace plumb
