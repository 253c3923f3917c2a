// The shape of a DynamicTree: heights, degenerate input, bulk changes, snapshots.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "engine/collision/broad_phase/dynamic_tree.h"
#include "engine/scene/error.h"

namespace plumb {
namespace {

template <class Real>
using Boxes = std::vector<Aabb<Real>>;

template <class Real>
Aabb<Real> square(double x, double y, double half) {
  return {{static_cast<Real>(x - half), static_cast<Real>(y - half)},
          {static_cast<Real>(x + half), static_cast<Real>(y + half)}};
}

template <class Real>
DynamicTree<Real> tree_of(const Boxes<Real>& boxes) {
  DynamicTree<Real> tree;
  for (int i = 0; i < static_cast<int>(boxes.size()); ++i) tree.insert(boxes[i], 1, i);
  return tree;
}

/// Boxes that fill a square to one half, in no order.
template <class Real>
Boxes<Real> scattered(int count, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(0, std::sqrt(2.0 * count));
  Boxes<Real> boxes;
  for (int i = 0; i < count; ++i) {
    const double x = uniform(random), y = uniform(random);
    boxes.push_back(square<Real>(x, y, 0.5));
  }
  return boxes;
}

/// The order of the users that a query of everything gives: it tells trees of different shape apart.
template <class Real>
std::vector<int> order(const DynamicTree<Real>& tree) {
  std::vector<int> users;
  tree.query(tree.bounds(), 1, [&](int user, int) { return users.push_back(user), true; });
  return users;
}

template <class Real>
std::vector<std::byte> bytes_of(const DynamicTree<Real>& tree) {
  std::vector<std::byte> bytes;
  tree.save(bytes);
  return bytes;
}

template <class Real>
void restore(DynamicTree<Real>& tree, const std::vector<std::byte>& bytes) {
  std::span<const std::byte> rest(bytes);
  tree.restore(rest);
  EXPECT_TRUE(rest.empty());
}

template <class Real>
class DynamicTreeShape : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(DynamicTreeShape, Reals);

// A tree of n leaves is at least log2 n + 1 nodes high; a red-black tree may be twice as high.
template <class Real>
void expect_low(const Boxes<Real>& boxes, double times) {
  DynamicTree<Real> tree = tree_of(boxes);
  const double least = std::log2(boxes.size()) + 1;
  EXPECT_TRUE(tree.valid());
  EXPECT_LE(tree.height(), times * least) << "inserted";
  tree.rebuild_all();
  EXPECT_TRUE(tree.valid());
  EXPECT_LE(tree.height(), 2 * least) << "rebuilt";
  EXPECT_EQ(order(tree).size(), boxes.size());
  for (int i = 0; i < tree.size(); ++i) {
    const Aabb<Real> grown = tree.box(i).grown(Real(0.25));
    tree.enlarge(i, grown);
  }
  tree.rebuild();
  EXPECT_TRUE(tree.valid());
  EXPECT_LE(tree.height(), 2 * least) << "enlarged and rebuilt";
  while (tree.size() > 1) tree.remove(tree.size() - 1);
  EXPECT_TRUE(tree.valid());
}

TYPED_TEST(DynamicTreeShape, RowsInOrder) {
  Boxes<TypeParam> row, column, slope;
  for (int i = 0; i < 4000; ++i) {
    row.push_back(square<TypeParam>(i, 0, 0.4));
    column.push_back(square<TypeParam>(0, -i, 0.6));
    slope.push_back(square<TypeParam>(0.5 * i, 0.5 * i, 0.5));
  }
  expect_low(row, 2);
  expect_low(column, 2);
  expect_low(slope, 2);
}

TYPED_TEST(DynamicTreeShape, IdenticalBoxesByTheThousand) {
  expect_low(Boxes<TypeParam>(5000, square<TypeParam>(3, 4, 0.5)), 3);
  expect_low(Boxes<TypeParam>(5000, square<TypeParam>(3, 4, 0)), 3);
}

// Each centre at twice the distance of the last one: splits at the middle would part off one at a time.
TYPED_TEST(DynamicTreeShape, CentersThatDouble) {
  Boxes<TypeParam> boxes;
  for (int i = -100; i < 100; ++i) boxes.push_back(square<TypeParam>(std::ldexp(1.0, i), 0, 0));
  DynamicTree<TypeParam> tree = tree_of(boxes);
  tree.rebuild_all();
  EXPECT_TRUE(tree.valid());
  EXPECT_LE(tree.height(), 3 * (std::log2(200) + 1));
}

TYPED_TEST(DynamicTreeShape, TheLargestNumbersAndInfinity) {
  using Real = TypeParam;
  constexpr Real kMax = std::numeric_limits<Real>::max(), kInfinity = std::numeric_limits<Real>::infinity();
  Boxes<Real> boxes = scattered<Real>(200);
  for (int i = 0; i < 50; ++i) {
    boxes.push_back({{-kMax, -kMax}, {kMax, kMax}});
    boxes.push_back({{-kInfinity, -1}, {kInfinity, 0}});
    boxes.push_back({{kMax, kMax}, {kMax, kMax}});
  }
  DynamicTree<Real> tree = tree_of(boxes);
  EXPECT_TRUE(tree.valid());
  for (int i = 0; i < 350; i += 2) tree.enlarge(i, boxes[(i + 1) % 350]);
  tree.rebuild();
  tree.rebuild_all();
  EXPECT_TRUE(tree.valid());
  EXPECT_EQ(order(tree).size(), boxes.size());
  int hits = 0;
  tree.ray_cast({0, -10}, {0, 100}, {0, 0}, 1, [&](int, Real most) { return ++hits, most; });
  EXPECT_GE(hits, 50);
}

// Nested boxes, each inserted around the last, make a chain: the higher tree is the better one for the
// heuristic. No traversal may rely on a height.
TYPED_TEST(DynamicTreeShape, TraversalsOfAChain) {
  using Real = TypeParam;
  constexpr int kBoxes = 3000;
  DynamicTree<Real> tree;
  double half = 1;
  for (int i = 0; i < kBoxes; ++i, half *= 1.01) tree.insert(square<Real>(0, 0, half), 1, i);
  ASSERT_TRUE(tree.valid());
  ASSERT_GT(tree.height(), 1000) << "otherwise this test is none";
  EXPECT_EQ(order(tree).size(), kBoxes);
  int hits = 0;
  tree.ray_cast({-10, 0}, {20, 0}, {0, 0}, 1, [&](int, Real most) { return ++hits, most; });
  EXPECT_EQ(hits, kBoxes);
  hits = 0;
  tree.nearest({0, 0}, 1, 1, [&](int, Real most) { return ++hits, most; });
  EXPECT_EQ(hits, kBoxes);
  hits = 0;
  tree.query(tree.bounds(), 1, [&](int, int) { return ++hits < 2000; });
  EXPECT_EQ(hits, 2000);
  tree.rebuild_all();
  EXPECT_LE(tree.height(), 2 * std::log2(kBoxes));
  EXPECT_TRUE(tree.valid());
}

// Two subtrees left waiting at each level need more room than one; in a chain of pairs all of them are inner.
TYPED_TEST(DynamicTreeShape, TraversalsOfAChainOfPairs) {
  using Real = TypeParam;
  constexpr int kPairs = 2000;
  DynamicTree<Real> tree;
  double half = 1;
  for (int i = 0; i < kPairs; ++i, half *= 1.01) {
    tree.insert(square<Real>(0, 0, half), 1, 2 * i);
    tree.insert(square<Real>(0, 0, half), 1, 2 * i + 1);
  }
  ASSERT_TRUE(tree.valid());
  EXPECT_EQ(order(tree).size(), 2 * kPairs);
  int hits = 0;
  tree.ray_cast({0, 0}, {0, 0}, {0, 0}, 1, [&](int, Real most) { return ++hits, most; });
  EXPECT_EQ(hits, 2 * kPairs);
}

// The number of boxes that a query of a leaf's size meets must not grow much when boxes are moved in bulk
// instead of one by one. The sum of perimeters decides; a tree of leaves put in one at a time by the surface-
// area heuristic is the measure.
TYPED_TEST(DynamicTreeShape, StaysGoodInLongMotion) {
  using Real = TypeParam;
  constexpr int kBoxes = 2000;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-0.3, 0.3);
  Boxes<Real> boxes = scattered<Real>(kBoxes);
  DynamicTree<Real> tree = tree_of(boxes);
  int rebuilds = 0;
  for (int step = 0; step < 300; ++step) {
    for (int i = step % 3; i < kBoxes; i += 3) {
      const double side = std::sqrt(2.0 * kBoxes);
      const Vec2<Real> at = boxes[i].lower, center{static_cast<Real>(side / 2), static_cast<Real>(side / 2)};
      const Vec2<Real> by = cross(Real(0.005), at - center) + Vec2<Real>{static_cast<Real>(uniform(random)),
                                                                         static_cast<Real>(uniform(random))};
      boxes[i] = {boxes[i].lower + by, boxes[i].upper + by};
      tree.enlarge(i, boxes[i]);
    }
    rebuilds += tree.rebuild() > 0;
  }
  EXPECT_TRUE(tree.valid());
  EXPECT_GE(rebuilds, 7);
  EXPECT_LT(tree.cost(), 1.15 * tree_of(boxes).cost());
}

// Boxes that move together keep their neighbours: they are made exact in place, and no leaf moves within the
// tree. The tree is as good as a new one, as its boxes are those of the start, carried along.
TYPED_TEST(DynamicTreeShape, MovesAlongWithoutBuilding) {
  using Real = TypeParam;
  constexpr int kBoxes = 2000, kSteps = 64;
  Boxes<Real> boxes = scattered<Real>(kBoxes);
  DynamicTree<Real> tree = tree_of(boxes);
  tree.rebuild_all();
  const double cost = tree.cost();
  const std::vector<int> before = order(tree);
  for (int step = 0; step < kSteps; ++step) {
    for (int i = 0; i < kBoxes; ++i) {
      const Vec2<Real> by{Real(0.25), Real(-0.5)};
      boxes[i] = {boxes[i].lower + by, boxes[i].upper + by};
      tree.enlarge(i, boxes[i]);
    }
    EXPECT_EQ(tree.rebuild(), 0) << step;
  }
  EXPECT_TRUE(tree.valid());
  EXPECT_EQ(order(tree), before);
  // Inner boxes are exact. Sides of up to 64 m were rounded 64 times: by half a unit of 64 epsilon at most.
  const double rounding = 64.0 * kSteps * static_cast<double>(std::numeric_limits<Real>::epsilon());
  EXPECT_NEAR(tree.cost(), cost, rounding * cost);
}

// More pairs than a cache holds are put in order before they are built from: of all of the tree, and of less
// than half of it, where the others stay.
TYPED_TEST(DynamicTreeShape, LargeTreesAreBuiltAnewFromAllTheyHad) {
  using Real = TypeParam;
  constexpr int kBoxes = 50'000, kPart = 20'000;
  Boxes<Real> boxes = scattered<Real>(kBoxes);
  std::sort(boxes.begin(), boxes.end(), [](const auto& a, const auto& b) { return a.lower.x < b.lower.x; });
  DynamicTree<Real> tree = tree_of(boxes);
  for (const int part : {kPart, kBoxes}) {
    for (int round = 0; round < 3; ++round)
      for (int i = 0; i < part; ++i) {
        boxes[i] = boxes[i].grown(Real(0.01));
        tree.enlarge(i, boxes[i]);
      }
    EXPECT_GE(tree.rebuild(), part);
    EXPECT_TRUE(tree.valid());
    std::vector<int> all = order(tree);
    std::sort(all.begin(), all.end());
    ASSERT_EQ(static_cast<int>(all.size()), kBoxes);
    for (int i = 0; i < kBoxes; ++i) ASSERT_EQ(all[i], i);
  }
}

// A leaf that goes to the other end of the world must not take the boxes above it along.
TYPED_TEST(DynamicTreeShape, LeapsDoNotStretchTheTree) {
  using Real = TypeParam;
  constexpr int kBoxes = 2000;
  Boxes<Real> boxes = scattered<Real>(kBoxes);
  DynamicTree<Real> tree = tree_of(boxes);
  for (int i = 0; i < 40; ++i) {
    boxes[i] = boxes[kBoxes - 1 - i];
    tree.enlarge(i, boxes[i]);
  }
  EXPECT_TRUE(tree.valid());
  EXPECT_LT(tree.cost(), 1.1 * tree_of(boxes).cost());
}

TYPED_TEST(DynamicTreeShape, RebuildsOnlyWhatIsMarked) {
  using Real = TypeParam;
  constexpr int kBoxes = 4096;
  DynamicTree<Real> tree = tree_of(scattered<Real>(kBoxes));
  EXPECT_EQ(tree.rebuild(), 0);
  // One leaf, until its turn comes: the way to it is about as long as the tree is high.
  int arranged = 0, times = 0;
  while (arranged == 0) {
    tree.enlarge(17, tree.box(17).grown(Real(0.01)));
    arranged = tree.rebuild();
    ASSERT_LT(++times, 100);
  }
  EXPECT_TRUE(tree.valid());
  EXPECT_LE(arranged, tree.height() + 1);
  EXPECT_LE(times, arranged);
  EXPECT_EQ(tree.rebuild(), 0) << "nothing is marked any more";
}

// The same operations on the copy and on the original: the same bits, and the same proxies.
TYPED_TEST(DynamicTreeShape, ASnapshotGoesOnWithTheSameBits) {
  using Real = TypeParam;
  DynamicTree<Real> tree = tree_of(scattered<Real>(500));
  const Boxes<Real> others = scattered<Real>(500, 2);
  for (int i = 0; i < 500; i += 7) tree.remove(i);
  for (int i = 1; i < 500; i += 7) tree.enlarge(i, tree.box(i).grown(Real(0.5)));
  DynamicTree<Real> copy = tree_of(scattered<Real>(9));
  restore(copy, bytes_of(tree));
  EXPECT_EQ(bytes_of(copy), bytes_of(tree));
  const auto go_on = [&](DynamicTree<Real>& each) {
    std::vector<int> result;
    for (int i = 0; i < 500; ++i) {
      if (i % 7 == 3) each.move(i, others[i]);
      if (i % 7 == 0) result.push_back(each.insert(others[i], 1, i));
      if (i % 7 == 4) each.enlarge(i, merged(each.box(i), each.box(i).grown(Real(0.2))));
      if (i % 50 == 0) result.push_back(each.rebuild());
      if (i % 7 == 5) each.remove(i);
    }
    for (const int user : order(each)) result.push_back(user);
    return result;
  };
  EXPECT_EQ(go_on(copy), go_on(tree));
  EXPECT_EQ(bytes_of(copy), bytes_of(tree));
  EXPECT_TRUE(tree.valid());
}

// A long history gives one tree, with every compiler, optimisation and instruction set. The value was
// recorded from g++ at -O2 and found again with clang++ at -O1 and without explicit SIMD.
TEST(DynamicTreeBits, OneHistoryGivesOneTree) {
  std::mt19937 random(11);
  const auto number = [&](int end) { return static_cast<int>(random() % static_cast<unsigned>(end)); };
  const auto box = [&] {
    const float x = 0.01f * static_cast<float>(number(4000)), y = 0.01f * static_cast<float>(number(4000));
    return Aabb<float>{{x, y}, {x + 0.01f * static_cast<float>(number(200)), y + 0.7f}};
  };
  DynamicTree<float> tree;
  const auto insert = [&](int user) {
    const std::uint32_t category = 1u << number(8);  // before the box: arguments are evaluated in any order
    return tree.insert(box(), category, user);
  };
  for (int i = 0; i < 1000; ++i) insert(i);
  std::uint64_t hash = 14695981039346656037u;  // FNV-1a
  const auto add = [&](std::uint64_t value) { hash = (hash ^ value) * 1099511628211u; };
  for (int step = 0; step < 50; ++step) {
    for (int i = 0; i < 100; ++i) {
      const int proxy = number(1000);
      if (i % 10 == 0) {
        tree.move(proxy, box());
      } else if (i % 10 == 1) {
        tree.remove(proxy);
        add(static_cast<std::uint64_t>(insert(proxy)));
      } else {
        const Aabb<float> old = tree.box(proxy);
        const Vec2<float> by{0.01f * static_cast<float>(number(21) - 10), 0.013f};
        tree.enlarge(proxy, {old.lower + by, old.upper + by});
      }
    }
    add(static_cast<std::uint64_t>(tree.rebuild()));
    tree.query(box().grown(3), 0x5a,
               [&](int user, int) { return add(static_cast<std::uint64_t>(user)), true; });
  }
  for (const std::byte each : bytes_of(tree)) add(static_cast<std::uint64_t>(each));
  EXPECT_EQ(hash, 14849480604048718292u);
}

// Any single byte changed: refused, or a tree that holds together. Cut off anywhere: refused. What refuses
// stays as it was.
TYPED_TEST(DynamicTreeShape, DamagedSnapshotsAreRefused) {
  using Real = TypeParam;
  DynamicTree<Real> tree = tree_of(scattered<Real>(30));
  for (int i = 0; i < 10; ++i) tree.remove(i);
  tree.enlarge(12, tree.box(12).grown(1));
  const std::vector<std::byte> good = bytes_of(tree);
  DynamicTree<Real> target = tree_of(scattered<Real>(5));
  const std::vector<std::byte> before = bytes_of(target);
  for (std::size_t size = 0; size < good.size(); ++size) {
    std::span<const std::byte> cut(good.data(), size);
    EXPECT_THROW(target.restore(cut), Error) << size;
    EXPECT_EQ(cut.size(), size);
  }
  EXPECT_EQ(bytes_of(target), before);
  int refused = 0, accepted = 0;
  for (std::size_t at = 0; at < good.size(); ++at)
    for (const int flip : {1, 0x80, 0xff}) {
      std::vector<std::byte> bad = good;
      bad[at] ^= static_cast<std::byte>(flip);
      DynamicTree<Real> result;
      std::span<const std::byte> in(bad);
      try {
        result.restore(in);
        ++accepted;
        EXPECT_TRUE(result.valid());
        EXPECT_EQ(result.size(), 20);
        EXPECT_LE(order(result).size(), 20u);
      } catch (const Error& error) {
        ++refused;
        EXPECT_EQ(error.kind(), Error::Kind::Value);
        EXPECT_EQ(error.subject(), "snapshot");
      }
    }
  EXPECT_GT(refused, accepted)
      << "users' numbers, boxes inside others, free nodes and counters are not checked";
}

// Coordinates whose double would overflow.
TYPED_TEST(DynamicTreeShape, CountsThatNoRunReachesAreRefused) {
  const std::vector<std::byte> good = bytes_of(tree_of(scattered<TypeParam>(30)));
  for (const std::size_t highest : {11u, 19u}) {
    for (const int flip : {0x80, 0x40}) {
      std::vector<std::byte> bad = good;
      bad[highest] ^= static_cast<std::byte>(flip);
      DynamicTree<TypeParam> result;
      std::span<const std::byte> in(bad);
      EXPECT_THROW(result.restore(in), Error) << highest;
    }
  }
}

TYPED_TEST(DynamicTreeShape, ABoxOfTheTreeItselfMayBeGiven) {
  DynamicTree<TypeParam> two =
      tree_of(Boxes<TypeParam>{square<TypeParam>(0, 0, 1), square<TypeParam>(9, 9, 2)});
  two.move(0, two.box(1));
  EXPECT_EQ(two.box(0).lower.x, 7);
  DynamicTree<TypeParam> tree = tree_of(scattered<TypeParam>(64));
  for (int i = 0; i + 1 < 64; ++i) {
    const Aabb<TypeParam> box = tree.box(i + 1);
    tree.move(i, tree.box(i + 1));
    EXPECT_EQ(tree.box(i).lower, box.lower);
    EXPECT_EQ(tree.box(i).upper, box.upper);
    tree.enlarge(i, tree.box(63 - i));
    ASSERT_TRUE(tree.valid());
  }
}

}  // namespace
}  // namespace plumb
