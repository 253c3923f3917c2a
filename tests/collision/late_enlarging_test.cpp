#include "engine/collision/broad_phase/prefetched_enlarging.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <random>
#include <vector>

namespace plumb {
namespace {

template <class Real>
using LateEnlargingTest = testing::Test;

using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(LateEnlargingTest, Reals);

template <class Real>
std::vector<std::byte> bytes_of(const DynamicTree<Real>& tree) {
  std::vector<std::byte> out;
  tree.save(out);
  return out;
}

// Fewer boxes than wait, as many, and more; some leap, which takes leaves out and puts them in elsewhere, and
// some are given twice: the order counts.
TYPED_TEST(LateEnlargingTest, GivesTheTreeThatEnlargingAtOnceGives) {
  using Real = TypeParam;
  for (const int count : {0, 1, 7, 8, 9, 15, 16, 17, 32, 33, 200}) {
    SCOPED_TRACE(count);
    std::mt19937 random(count);
    const auto uniform = [&](double to) {
      return static_cast<Real>(std::uniform_real_distribution<double>(0, to)(random));
    };
    const auto some_box = [&](Vec2<Real> at) {
      return Aabb<Real>{at, {at.x + uniform(2), at.y + uniform(2)}};
    };
    DynamicTree<Real> at_once;
    for (int i = 0; i < 300; ++i) at_once.insert(some_box({uniform(40), uniform(40)}), 1, i);
    at_once.rebuild_all();
    DynamicTree<Real> tree = at_once;

    PrefetchedEnlarging<Real> late(tree);
    for (int i = 0; i < count; ++i) {
      const int proxy = std::uniform_int_distribution<int>(0, i % 5 == 0 ? 3 : 299)(random);
      const Aabb<Real> box =
          i % 9 == 0 ? some_box({uniform(40), uniform(40)}) : at_once.box(proxy).grown(uniform(1));
      at_once.enlarge(proxy, box);
      late.enlarge(proxy, box);
    }
    late.finish();
    EXPECT_EQ(bytes_of(tree), bytes_of(at_once));
    EXPECT_TRUE(tree.valid());
  }
}

}  // namespace
}  // namespace plumb
