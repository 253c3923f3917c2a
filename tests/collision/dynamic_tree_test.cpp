#include "engine/collision/broad_phase/dynamic_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <set>
#include <vector>

#include "engine/scene/error.h"

namespace plumb {
namespace {

constexpr double kWorld = 40;  // m, the side of the square in which the boxes lie

/// The same leaves in a plain list: what every query is compared with.
template <class Real>
struct Listed {
  bool used = false;
  Aabb<Real> box{};
  std::uint32_t category = 0;
  int user = 0;
};

template <class Real>
class DynamicTreeTest : public testing::Test {
 protected:
  Real uniform(double from, double to) {
    return static_cast<Real>(std::uniform_real_distribution<double>(from, to)(random_));
  }
  int below(int end) { return std::uniform_int_distribution<int>(0, end - 1)(random_); }
  Vec2<Real> somewhere() { return {uniform(0, kWorld), uniform(0, kWorld)}; }
  Aabb<Real> some_box() {
    const Vec2<Real> at = somewhere();
    switch (below(8)) {
      case 0:
        return {at, at};  // a point
      case 1:
        return {at, {at.x + uniform(0, kWorld / 2), at.y}};  // flat
      case 2:
        return {at, {at.x + uniform(0, kWorld / 2), at.y + uniform(0, kWorld / 2)}};
      case 3:
        return {{5, 5}, {6, 6}};  // the same as others
      default:
        return {at, {at.x + uniform(0, 2), at.y + uniform(0, 2)}};
    }
  }

  int some_leaf() {
    for (;;)
      if (const int proxy = below(static_cast<int>(list_.size())); list_[proxy].used) return proxy;
  }
  void insert() {
    const Listed<Real> leaf{true, some_box(), 1u << below(5), below(1000)};
    const int proxy = tree_.insert(leaf.box, leaf.category, leaf.user);
    ASSERT_GE(proxy, 0);
    if (proxy >= static_cast<int>(list_.size())) list_.resize(proxy + 1);
    ASSERT_FALSE(list_[proxy].used) << "a proxy names one leaf";
    list_[proxy] = leaf;
  }
  void remove() {
    const int proxy = some_leaf();
    tree_.remove(proxy);
    list_[proxy].used = false;
  }
  void move() {
    const int proxy = some_leaf();
    tree_.move(proxy, list_[proxy].box = some_box());
  }
  void enlarge() {
    const int proxy = some_leaf();
    Aabb<Real>& box = list_[proxy].box;
    box.lower -= {uniform(0, 0.5), uniform(0, 0.5)};
    box.upper += {uniform(0, 0.5), uniform(0, 0.5)};
    tree_.enlarge(proxy, box);
  }
  /// Moves a box as a body that goes on does: the new box contains neither the old one nor, at times, a part
  /// of it.
  void shift() {
    const int proxy = some_leaf();
    Aabb<Real>& box = list_[proxy].box;
    const Vec2<Real> by{uniform(-1, 1), uniform(-1, 1)};
    box = {box.lower + by, box.upper + by};
    tree_.enlarge(proxy, box);
  }
  void do_something(int most) {
    const int choice = below(20);
    const int size = tree_.size();
    if (size == 0 || (choice < 4 && size < most)) return insert();
    if (choice < 7) return size > most / 4 ? remove() : insert();
    if (choice < 10) return move();
    if (choice < 14) return enlarge();
    if (choice < 19) return shift();
    below(4) > 0 ? tree_.rebuild() : tree_.rebuild_all();
  }

  std::set<int> found(const Aabb<Real>& box, std::uint32_t mask) const {
    std::set<int> proxies;
    tree_.query(box, mask, [&](int user, int proxy) {
      EXPECT_TRUE(proxies.insert(proxy).second) << "visited twice";
      EXPECT_EQ(user, list_[proxy].user);
      return true;
    });
    return proxies;
  }
  template <class Holds>
  std::set<int> listed(std::uint32_t mask, const Holds& holds) const {
    std::set<int> proxies;
    for (int i = 0; i < static_cast<int>(list_.size()); ++i)
      if (list_[i].used && (list_[i].category & mask) != 0 && holds(list_[i].box)) proxies.insert(i);
    return proxies;
  }
  void expect_the_same_as_listed() {
    ASSERT_TRUE(tree_.valid());
    int size = 0;
    for (int i = 0; i < static_cast<int>(list_.size()); ++i) {
      if (!list_[i].used) continue;
      ++size;
      EXPECT_TRUE(tree_.box(i).lower == list_[i].box.lower && tree_.box(i).upper == list_[i].box.upper);
      EXPECT_EQ(tree_.user(i), list_[i].user);
      EXPECT_EQ(tree_.category(i), list_[i].category);
    }
    EXPECT_EQ(tree_.size(), size);
    for (int i = 0; i < 5; ++i) {
      const Aabb<Real> window = some_box();
      const std::uint32_t mask = i == 0 ? DynamicTree<Real>::kAll : static_cast<std::uint32_t>(below(32));
      EXPECT_EQ(found(window, mask),
                listed(mask, [&](const Aabb<Real>& box) { return box.overlaps(window); }));
    }
  }

  std::mt19937 random_{1};
  DynamicTree<Real> tree_;
  std::vector<Listed<Real>> list_;
};

using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(DynamicTreeTest, Reals);

TYPED_TEST(DynamicTreeTest, AnyOperationsAgreeWithAList) {
  for (const int most : {3, 40, 400}) {
    for (int round = 0; round < 6000; ++round) {
      this->do_something(most);
      if (round % (most / 2) == 0) this->expect_the_same_as_listed();
      if (this->HasFatalFailure()) return;
    }
    while (this->tree_.size() > 0) this->remove();
    this->expect_the_same_as_listed();
  }
}

TYPED_TEST(DynamicTreeTest, AQueryStopsWhenItIsTold) {
  for (int i = 0; i < 100; ++i) this->insert();
  int visits = 0;
  this->tree_.query(this->tree_.bounds(), DynamicTree<TypeParam>::kAll,
                    [&](int, int) { return ++visits < 7; });
  EXPECT_EQ(visits, 7);
}

TYPED_TEST(DynamicTreeTest, EmptyAndSingle) {
  using Real = TypeParam;
  DynamicTree<Real> tree;
  const Aabb<Real> unit{{0, 0}, {1, 1}};
  int visits = 0;
  const auto look = [&] {
    tree.query(unit, 1, [&](int, int) { return ++visits > 0; });
    tree.ray_cast({-1, 0}, {3, 0}, {0, 0}, 1, [&](int, Real fraction) { return ++visits, fraction; });
    tree.nearest({2, 0}, 1, 1, [&](int, Real distance) { return ++visits, distance; });
    return std::exchange(visits, 0);
  };
  EXPECT_EQ(look(), 0);
  EXPECT_EQ(tree.rebuild(), 0);
  EXPECT_EQ(tree.height(), 0);
  EXPECT_TRUE(tree.valid());
  const int proxy = tree.insert(unit, 1, 7);
  EXPECT_EQ(look(), 3);
  EXPECT_EQ(tree.height(), 1);
  tree.enlarge(proxy, {{0, 0}, {1, 2}});
  EXPECT_EQ(tree.rebuild() + tree.rebuild_all(), 0);
  EXPECT_EQ(tree.bounds().upper.y, 2);
  tree.move(proxy, {{8, 8}, {9, 9}});
  EXPECT_TRUE(tree.valid());
  tree.remove(proxy);
  EXPECT_EQ(tree.size(), 0);
  EXPECT_EQ(tree.insert(unit, 1, 7), proxy) << "the place is used again";
  tree.clear();
  EXPECT_TRUE(tree.valid());
  EXPECT_EQ(tree.insert(unit, 1, 7), 0);
}

/// When the point of the segment from `origin` that is `half` off in each direction meets the box, in exact
/// enough arithmetic: by clipping against the four sides in turn, without a division by a component that is
/// 0. Infinite when it does not.
template <class Real>
long double met_at(const Aabb<Real>& box, Vec2<Real> origin, Vec2<Real> translation, Vec2<Real> half) {
  long double from = 0, to = 1;
  const auto clip = [&](long double start, long double step, long double lower, long double upper) {
    if (step < 0) {
      start = -start;
      step = -step;
      std::swap(lower, upper);
      lower = -lower;
      upper = -upper;
    }
    if (step == 0) {
      if (start < lower || start > upper) to = -1;
      return;
    }
    from = std::max(from, (lower - start) / step);
    to = std::min(to, (upper - start) / step);
  };
  const auto lower = box.lower.template as<long double>(), upper = box.upper.template as<long double>();
  clip(origin.x, translation.x, lower.x - half.x, upper.x + half.x);
  clip(origin.y, translation.y, lower.y - half.y, upper.y + half.y);
  return from <= to ? from : std::numeric_limits<long double>::infinity();
}

// Every leaf that long double says is met must be visited. Those visited besides must be met when grown by
// the margin of rounding: a few units of roundoff of the coordinates.
TYPED_TEST(DynamicTreeTest, SweepsMeetWhatAListOfBoxesSays) {
  using Real = TypeParam;
  for (int i = 0; i < 300; ++i) this->insert();
  const Real margin = 16 * std::numeric_limits<Real>::epsilon() * static_cast<Real>(kWorld);
  int met = 0;
  for (int round = 0; round < 3000; ++round) {
    if (round % 20 == 0) this->do_something(300);
    Vec2<Real> origin = this->somewhere();
    Vec2<Real> translation = this->somewhere() - this->somewhere();
    if (round % 5 == 1) translation.x = 0;
    if (round % 5 == 2) translation.y = 0;
    if (round % 50 == 3) translation = {};
    // Along sides and through corners.
    if (round % 3 == 0) origin = this->list_[this->some_leaf()].box.lower;
    if (round % 7 == 0) translation = this->list_[this->some_leaf()].box.upper - origin;
    const Vec2<Real> half =
        round % 2 == 0 ? Vec2<Real>{} : Vec2<Real>{this->uniform(0, 2), this->uniform(0, 2)};
    const std::uint32_t mask = static_cast<std::uint32_t>(this->below(32));
    std::multiset<int> users;
    this->tree_.ray_cast(origin, translation, half, mask, [&](int user, Real fraction) {
      EXPECT_EQ(fraction, 1);
      users.insert(user);
      return fraction;
    });
    std::multiset<int> least, most;
    for (const auto& leaf : this->list_) {
      if (!leaf.used || (leaf.category & mask) == 0) continue;
      if (met_at(leaf.box, origin, translation, half) <= 1) least.insert(leaf.user);
      if (met_at(leaf.box.grown(margin), origin, translation, half) <= 1) most.insert(leaf.user);
    }
    met += static_cast<int>(least.size());
    EXPECT_TRUE(std::includes(users.begin(), users.end(), least.begin(), least.end())) << "round " << round;
    EXPECT_TRUE(std::includes(most.begin(), most.end(), users.begin(), users.end())) << "round " << round;
  }
  EXPECT_GT(met, 10000);
}

// A swept box whose side slides along a leaf's, or that stops where it touches: whether they do is a matter
// of the last bit, and what exact arithmetic calls touching must be visited.
TYPED_TEST(DynamicTreeTest, SweepsThatOnlyTouch) {
  using Real = TypeParam;
  DynamicTree<Real> tree;
  tree.insert({{0, 0}, {1, 1}}, 1, 0);
  int touching = 0;
  for (int round = 0; round < 20000; ++round) {
    const Vec2<Real> lower{this->uniform(0, 1), this->uniform(0, 1)};
    tree.move(0, {lower, {lower.x + 1, lower.y + 1}});
    const Vec2<Real> half{this->uniform(0, 2), this->uniform(0, 2)};
    Vec2<Real> origin{-3, lower.y - half.y}, translation{9, 0};
    if (round % 2 == 0) {
      const Real gap = this->uniform(0, 100) * std::numeric_limits<Real>::epsilon();
      origin = {lower.x - half.x - gap, lower.y};
      translation.x = static_cast<Real>((long double)lower.x - half.x - origin.x);
    }
    bool visited = false;
    tree.ray_cast(origin, translation, half, 1, [&](int, Real fraction) { return visited = true, fraction; });
    if (met_at(tree.box(0), origin, translation, half) > 1) continue;
    ++touching;
    EXPECT_TRUE(visited);
  }
  EXPECT_GT(touching, 10000);
}

TYPED_TEST(DynamicTreeTest, SweepsFindTheFirstAndLookAtFew) {
  using Real = TypeParam;
  constexpr int kBoxes = 2000;
  std::vector<Aabb<Real>> boxes;
  for (int i = 0; i < kBoxes; ++i) {
    const Vec2<Real> at = this->somewhere();
    boxes.push_back({at, {at.x + Real(0.5), at.y + Real(0.5)}});
    this->tree_.insert(boxes.back(), 1, i);
  }
  int visits = 0, visits_of_all = 0;
  for (int round = 0; round < 200; ++round) {
    const Vec2<Real> origin = this->somewhere(), translation = this->somewhere() - origin;
    const auto fraction_of = [&](int i) { return met_at(boxes[i], origin, translation, {}); };
    long double expected = std::numeric_limits<long double>::infinity(), nearest = expected;
    for (int i = 0; i < kBoxes; ++i) {
      expected = std::min(expected, fraction_of(i));
      visits_of_all += fraction_of(i) <= 1;
    }
    this->tree_.ray_cast(origin, translation, {0, 0}, 1, [&](int i, Real most) -> Real {
      ++visits;
      nearest = std::min(nearest, fraction_of(i));
      return std::min(most, static_cast<Real>(fraction_of(i)));
    });
    EXPECT_EQ(nearest, expected);
  }
  EXPECT_LT(visits, 3 * 200) << "nearer subtrees first";
  EXPECT_GT(visits_of_all, 10 * 200);
}

TYPED_TEST(DynamicTreeTest, NearestAgreesWithAListOfBoxes) {
  using Real = TypeParam;
  for (int i = 0; i < 300; ++i) this->insert();
  const auto distance = [](const Aabb<Real>& box, Vec2<Real> p) {
    const long double x = std::clamp(p.x, box.lower.x, box.upper.x),
                      y = std::clamp(p.y, box.lower.y, box.upper.y);
    return std::sqrt((x - p.x) * (x - p.x) + (y - p.y) * (y - p.y));
  };
  int visits = 0;
  for (int round = 0; round < 500; ++round) {
    if (round % 10 == 0) this->do_something(300);
    const Vec2<Real> point = this->somewhere();
    const std::uint32_t mask = 1u << this->below(5);
    const Real reach = this->uniform(0, 4);
    // All within reach.
    std::multiset<int> users, expected;
    this->tree_.nearest(point, mask, reach, [&](int user, Real most) { return users.insert(user), most; });
    long double least = std::numeric_limits<long double>::infinity(), nearest = least;
    for (const auto& leaf : this->list_) {
      if (!leaf.used || (leaf.category & mask) == 0) continue;
      least = std::min(least, distance(leaf.box, point));
      if (distance(leaf.box, point) <= reach) expected.insert(leaf.user);
    }
    EXPECT_TRUE(std::includes(users.begin(), users.end(), expected.begin(), expected.end()));
    EXPECT_LE(users.size(), expected.size() + 1) << "only rounding may add one";
    // The nearest of all. Users are not unique: the nearest box among those of the same number.
    this->tree_.nearest(point, mask, std::numeric_limits<Real>::infinity(), [&](int user, Real most) {
      ++visits;
      long double here = std::numeric_limits<long double>::infinity();
      for (const auto& leaf : this->list_)
        if (leaf.used && (leaf.category & mask) != 0 && leaf.user == user)
          here = std::min(here, distance(leaf.box, point));
      nearest = std::min(nearest, here);
      return std::min(most, static_cast<Real>(here));
    });
    EXPECT_NEAR(static_cast<double>(nearest), static_cast<double>(least),
                kWorld * static_cast<double>(std::numeric_limits<Real>::epsilon()));
  }
  EXPECT_LT(visits, 500 * 8);
}

TYPED_TEST(DynamicTreeTest, MasksPassOverSubtreesThatHaveNothing) {
  using Real = TypeParam;
  DynamicTree<Real> tree;
  for (int i = 0; i < 1000; ++i) {
    const Vec2<Real> at = this->somewhere();
    tree.insert({at, {at.x + 1, at.y + 1}}, i == 500 ? 4u : 3u, i);
  }
  std::vector<int> users;
  tree.query(tree.bounds(), 4, [&](int user, int) { return users.push_back(user), true; });
  EXPECT_EQ(users, std::vector<int>{500});
  tree.query(tree.bounds(), 8, [&](int, int) { return ADD_FAILURE(), true; });
}

}  // namespace
}  // namespace plumb
