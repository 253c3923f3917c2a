#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <set>
#include <vector>

#include "engine/world/snapshot.h"
#include "tests/world/support.h"

namespace plumb {
namespace {

using Reals = testing::Types<float, double>;
template <class Real>
using BodiesOfSeveralShapes = testing::Test;
TYPED_TEST_SUITE(BodiesOfSeveralShapes, Reals);

// m, from disc to disc: so near that one search for several costs less than one for each.
constexpr double kPitch = 0.55;

// A body of `count` discs side by side.
template <class Real>
void add_comb(BasicWorld<Real>& world, int count, Vec2d at, Vec2d velocity) {
  std::vector<ShapeDefinition> teeth;
  for (int i = 0; i < count; ++i)
    teeth.push_back({.geometry = Circle{0.25}, .position = {kPitch * (i - 0.5 * (count - 1)), 0}});
  BodyDefinition body;
  body.position = at, body.velocity = velocity;
  world.create_body(body, teeth);
}

// A comb moves onto a row of discs, one for each of its teeth. However many teeth are searched together, each
// meets its disc, whether that moves or is static, and meets no other.
TYPED_TEST(BodiesOfSeveralShapes, MeetWithEachShape) {
  for (const BodyType type : {BodyType::Static, BodyType::Dynamic}) {
    for (const int count : {2, 3, 8, 9, 20}) {
      BasicWorld<TypeParam> world(weightless());
      for (int i = 0; i < count; ++i) {
        world.create_body({.type = type, .position = {kPitch * (i - 0.5 * (count - 1)), 2}},
                          ShapeDefinition{.geometry = Circle{0.25}});
      }
      add_comb(world, count, {0, 0}, {0, 4});
      std::set<std::uint32_t> met;
      for (int step = 0; step < 30; ++step) {
        world.step();
        for (const TouchEvent& event : world.events().begin) {
          const std::uint32_t a = event.shape_a.index, b = event.shape_b.index;
          met.insert(a), met.insert(b);
          const std::uint32_t discs = static_cast<std::uint32_t>(count);
          EXPECT_EQ(a < b ? a + discs : b + discs, a < b ? b : a);
        }
      }
      std::set<std::uint32_t> expected;
      for (int i = 0; i < 2 * count; ++i) expected.insert(static_cast<std::uint32_t>(i));
      EXPECT_EQ(met, expected) << count << " teeth";
    }
  }
}

// Eight boxes in one place meet a field of more discs than one search holds.
TYPED_TEST(BodiesOfSeveralShapes, MeetAWholeCrowd) {
  BasicWorld<TypeParam> world(weightless());
  constexpr int kSide = 20;
  for (int i = 0; i < kSide * kSide; ++i) {
    world.create_body({.type = BodyType::Static, .position = {0.5 * (i % kSide), 0.5 * (i / kSide)}},
                      ShapeDefinition{.geometry = Circle{0.1}});
  }
  world.step();  // the field finds nothing any more: the boxes must
  const double middle = 0.25 * (kSide - 1);
  BodyDefinition body;
  body.position = {middle, middle};
  world.create_body(body, std::vector<ShapeDefinition>(8, {.geometry = Box{12, 12}}));
  std::set<std::uint32_t> met;
  for (int step = 0; step < 2; ++step) {
    world.step();
    for (const TouchEvent& event : world.events().begin) {
      met.insert(event.shape_a.index < event.shape_b.index ? event.shape_a.index : event.shape_b.index);
    }
  }
  EXPECT_EQ(met.size(), static_cast<std::size_t>(kSide * kSide));
}

// A heap of pairs of triangles goes on with the same bits from a snapshot of each step: what a step remembers
// of the last one beyond the state, as the faces that separated shapes, changes nothing.
TYPED_TEST(BodiesOfSeveralShapes, GoOnWithoutTheMemoryOfTheLastStep) {
  BasicWorld<TypeParam> world(without_sleep());
  add_ground(world);
  for (const double x : {-6.0, 6.0})
    world.create_body({.type = BodyType::Static, .position = {x, 5}},
                      ShapeDefinition{.geometry = Box{1, 20}});
  const std::vector<ShapeDefinition> pair{{.geometry = Polygon{{{-1, 0}, {0.5, 1}, {0, 2}}, 0}},
                                          {.geometry = Polygon{{{1, 0}, {0, 2}, {-0.5, 1}}, 0}}};
  for (int i = 0; i < 30; ++i) {
    BodyDefinition body;
    body.position = {2.1 * (i % 5) - 4.2 + 0.1 * (i % 3), 1.0 + 2.25 * (i / 5)};
    world.create_body(body, pair);
  }
  for (int step = 0; step < 180; ++step) {
    BasicWorld<TypeParam> fresh(without_sleep());
    restore(fresh, save(world));
    world.step(), fresh.step();
    ASSERT_EQ(fresh.hash(), world.hash()) << "step " << step;
  }
}

}  // namespace
}  // namespace plumb
