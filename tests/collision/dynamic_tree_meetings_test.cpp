#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "engine/collision/broad_phase/dynamic_tree.h"

namespace plumb {
namespace {

// By proxy, of `boxes` in the order in which they were inserted: each with each.
template <class Real>
std::vector<char> by_comparing_all(const std::vector<Aabb<Real>>& boxes) {
  std::vector<char> meets(boxes.size(), 0);
  for (std::size_t i = 0; i < boxes.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (boxes[i].overlaps(boxes[j])) meets[i] = meets[j] = 1;
  return meets;
}

template <class Real>
class DynamicTreeMeetings : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(DynamicTreeMeetings, Reals);

// While boxes come, grow and go, with the tree built anew and not.
TYPED_TEST(DynamicTreeMeetings, AreThoseOfEachWithEach) {
  using Real = TypeParam;
  std::mt19937_64 random(5);
  const auto uniform = [&](double to) {
    return static_cast<Real>(std::uniform_real_distribution<double>(0, to)(random));
  };
  DynamicTree<Real> tree;
  std::vector<Aabb<Real>> boxes;
  std::vector<char> meets;
  EXPECT_TRUE(tree.mark_self_overlaps(meets, 0));
  EXPECT_TRUE(meets.empty());
  int met = 0;
  for (int round = 0; round < 200; ++round) {
    const Vec2<Real> at{uniform(60), uniform(60)};
    boxes.push_back({at, {at.x + uniform(2), at.y + uniform(2)}});
    tree.insert(boxes.back(), 1, round);
    for (int each = 0; each < 3; ++each) {
      const int proxy = static_cast<int>(random() % boxes.size());
      boxes[proxy].upper.x += uniform(0.2);
      tree.enlarge(proxy, boxes[proxy]);
    }
    if (round % 3 == 0) tree.rebuild();
    if (round % 50 == 49) tree.rebuild_all();
    ASSERT_TRUE(tree.mark_self_overlaps(meets, 1 << 20));
    ASSERT_EQ(meets, by_comparing_all(boxes)) << "round " << round;
    for (const char each : meets) met += each;
  }
  EXPECT_GT(met, 1000);
  EXPECT_LT(met, 15000) << "not all";
  // A removed box meets nothing.
  for (int proxy = 0; proxy < 200; ++proxy) tree.remove(proxy);
  ASSERT_TRUE(tree.mark_self_overlaps(meets, 1 << 20));
  EXPECT_EQ(meets, std::vector<char>(200, 0));
  const int last = tree.insert({{-1, -1}, {1, 1}}, 1, 0);  // around where free places have their boxes
  ASSERT_TRUE(tree.mark_self_overlaps(meets, 1 << 20));
  EXPECT_EQ(meets[last], 0);
}

// 10000 boxes apart from each other take no more comparisons than there are, a heap takes more.
TYPED_TEST(DynamicTreeMeetings, CostLittleWhereFewMeet) {
  using Real = TypeParam;
  for (const bool apart : {true, false}) {
    DynamicTree<Real> tree;
    for (int i = 0; i < 10000; ++i) {
      const Vec2<Real> at{static_cast<Real>(3 * (i / 100)), static_cast<Real>(3 * (i % 100))};
      const Real size = apart ? Real(2) : Real(6);
      tree.insert({at, {at.x + size, at.y + size}}, 1, i);
    }
    tree.rebuild_all();
    std::vector<char> meets;
    EXPECT_EQ(tree.mark_self_overlaps(meets, apart ? 100 : 10000), apart);
  }
}

}  // namespace
}  // namespace plumb
