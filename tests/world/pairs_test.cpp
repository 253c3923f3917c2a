#include <gtest/gtest.h>

#include <cstdint>
#include <set>

#include "tests/world/support.h"

namespace plumb {
namespace {

constexpr int kSide = 40;

using Reals = testing::Types<float, double>;
template <class Real>
using Pairs = testing::Test;
TYPED_TEST_SUITE(Pairs, Reals);

// Discs fly side by side, so many that who meets anybody is found in one pass. Beside every hundredth comes
// one from the side, and they meet after half a second: each of these pairs is found, with grounds (on which
// the lowest row lands) and without, and no other.
TYPED_TEST(Pairs, OfTheFewThatMeetAmongManyAreFound) {
  using Real = TypeParam;
  for (const bool grounds : {false, true}) {
    SCOPED_TRACE(grounds ? "with a ground" : "without grounds");
    BasicWorld<Real> world(weightless());
    const ShapeDefinition disc{.geometry = Circle{0.25}};
    if (grounds) {
      world.create_body({.type = BodyType::Static, .position = {0, -2}},
                        ShapeDefinition{.geometry = Box{400, 2}});
    }
    std::set<std::uint32_t> expected, met;
    for (int i = 0; i < kSide * kSide; ++i) {
      const Vec2d at{3.0 * (i % kSide), 3.0 * (i / kSide)};
      add_body(world, at, disc, {0, -3});
      if (i % 100 != 50) continue;
      expected.insert(add_body(world, {at.x + 1.5, at.y}, disc, {-2, -3}).index);
    }
    int landed = 0;
    for (int step = 0; step < 40; ++step) {
      world.step();
      for (const TouchEvent& event : world.events().begin) {
        // A shape a body: they have the same index.
        const std::uint32_t a = event.shape_a.index, b = event.shape_b.index;
        if (grounds && (a == 0 || b == 0)) {
          ++landed;
        } else {
          met.insert(expected.contains(a) ? a : b);
        }
      }
    }
    EXPECT_EQ(met, expected);
    EXPECT_EQ(landed, grounds ? kSide : 0);
  }
}

}  // namespace
}  // namespace plumb
