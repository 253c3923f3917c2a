#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "engine/world/snapshot.h"
#include "engine/world/state_hash.h"
#include "tests/world/allocations.h"
#include "tests/world/mechanisms.h"
#include "tests/world/support.h"
#include "tests/world/vector_widths.h"

// Contacts of one colour are solved side by side, as many as fit into the processor's registers. Whoever
// plays the same on another machine must see the same bits.
namespace plumb {
namespace {

template <class Real>
class SideBySide : public testing::Test {};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(SideBySide, Precisions);

// A room with a belt and a turning paddle, into which bodies of all kinds and materials fall: one and two
// points, soft and stiff, rolling, bouncing, with heavy bodies on light ones and some on joints.
template <class Real>
void fill_room(BasicWorld<Real>& world, unsigned seed, int count, double bouncing) {
  std::mt19937 from(seed);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(from);
  };
  const BodyId room = world.create_body({.type = BodyType::Static});
  world.create_shape(room,
                     {.geometry = Box{30, 1}, .position = {0, -0.5}, .material = {.surface_speed = 0.4}});
  world.create_shape(room, {.geometry = Box{1, 40}, .position = {-6, 20}});
  world.create_shape(room, {.geometry = Box{1, 40}, .position = {6, 20}});
  world.create_body(
      {.type = BodyType::Kinematic, .position = {0, 2}, .velocity = {-0.0, 0}, .angular_velocity = 1},
      ShapeDefinition{.geometry = Box{4, 0.3}});
  BodyId last = room;
  for (int i = 0; i < count; ++i) {
    const double size = between(0.3, 0.6);
    const ShapeGeometry kinds[] = {
        Circle{size / 2}, Box{size, size}, Capsule{{-size / 3, 0}, {size / 3, 0}, size / 4},
        Polygon{{{-size / 2, -size / 3}, {size / 2, -size / 3}, {0, size / 2}}, 0.02}};
    const ShapeDefinition shape{.geometry = kinds[i % 4],
                                .density = i % 9 == 0 ? 20.0 : 1.0,
                                .material = {.friction = between(0, 1),
                                             .restitution = between(0, 1) < bouncing ? 0.4 : 0.0,
                                             .rolling_resistance = i % 3 == 0 ? 0.05 : 0.0}};
    const BodyId body =
        world.create_body({.position = {-4.5 + 0.9 * (i % 11) + between(-0.1, 0.1), 3.5 + 0.8 * (i / 11)},
                           .angle = between(0, 6)},
                          shape);
    if (i % 23 == 22)
      world.create_joint(last, body, {.kind = DistanceDefinition{.length = 1.2, .spring = Spring{4, 0.5}}});
    last = body;
  }
}

template <class Real>
std::vector<std::uint64_t> hashes_of_room(unsigned seed, double bouncing, Solver solver) {
  BasicWorld<Real> world({.solver = solver});
  fill_room(world, seed, 160, bouncing);
  std::vector<std::uint64_t> hashes;
  for (int i = 0; i < 240; ++i) {
    // Steps of another length scale the impulses that are kept.
    world.step(i % 50 == 49 ? 1.0 / 100 : 1.0 / 60, 4);
    hashes.push_back(full_hash(world));
  }
  return hashes;
}

// Returns the first step after which two runs differ, or -1.
int first_difference(const std::vector<std::uint64_t>& one, const std::vector<std::uint64_t>& other) {
  for (std::size_t i = 0; i < one.size(); ++i)
    if (one[i] != other[i]) return static_cast<int>(i);
  return -1;
}

TYPED_TEST(SideBySide, HeapsOfAllKindsHaveTheSameBitsAtEachWidth) {
  using Real = TypeParam;
  for (unsigned seed = 1; seed <= 4; ++seed) {
    const double bouncing = seed % 2 == 0 ? 0.2 : 0;
    std::vector<std::uint64_t> first;
    test::at_each_vector_width([&](VectorWidth) {
      const std::vector<std::uint64_t> hashes = hashes_of_room<Real>(seed, bouncing, Solver::SoftSteps);
      if (first.empty()) first = hashes;
      ASSERT_EQ(first_difference(hashes, first), -1) << "seed " << seed;
    });
  }
}

TYPED_TEST(SideBySide, HeapsInTheDirectSolverHaveTheSameBitsAtEachWidth) {
  using Real = TypeParam;
  std::vector<std::uint64_t> first;
  test::at_each_vector_width([&](VectorWidth) {
    const std::vector<std::uint64_t> hashes = hashes_of_room<Real>(7, 0.1, Solver::Direct);
    if (first.empty()) first = hashes;
    ASSERT_EQ(first_difference(hashes, first), -1);
  });
}

// Gaps of joints are closed after the joints were evaluated, so what is kept of their angles is that of the
// step's end, however many of them are solved side by side.
TYPED_TEST(SideBySide, MechanismsHaveTheSameBitsAtEachWidth) {
  using Real = TypeParam;
  for (const std::uint64_t seed : {32, 110}) {  // a tree and a bridge of sliders, whose gaps are closed
    test::Draw draw(seed);
    const test::Plan plan = test::draw_plan(draw);
    for (const int substeps : {1, 4}) {
      std::vector<std::uint64_t> first;
      test::at_each_vector_width([&](VectorWidth) {
        test::Mechanism<Real> mechanism = test::build<Real>(plan, seed);
        std::vector<std::uint64_t> hashes;
        for (int i = 0; i < 60; ++i) {
          mechanism.world.step(1.0 / 60, substeps);
          hashes.push_back(full_hash(mechanism.world));
        }
        if (first.empty()) first = hashes;
        ASSERT_EQ(first_difference(hashes, first), -1) << plan.text() << ", substeps " << substeps;
      });
    }
  }
}

// The width may change with the machine on which a saved world goes on.
TYPED_TEST(SideBySide, AWorldGoesOnAtAnotherWidth) {
  using Real = TypeParam;
  BasicWorld<Real> world;
  fill_room(world, 3, 120, 0.1);
  run(world, 100);
  const std::vector<std::byte> bytes = save(world);
  run(world, 50);
  test::at_each_vector_width([&](VectorWidth) {
    BasicWorld<Real> other;
    restore(other, bytes);
    run(other, 50);
    EXPECT_EQ(full_hash(other), full_hash(world));
  });
}

// Of few contacts, blocks are not worth building; of any number, the rest that does not fill a block is
// solved with the same bits.
TYPED_TEST(SideBySide, HeapsOfEachSizeHaveTheSameBitsAtEachWidth) {
  using Real = TypeParam;
  for (int base = 2; base <= 14; ++base) {
    std::vector<std::uint64_t> first;
    test::at_each_vector_width([&](VectorWidth) {
      BasicWorld<Real> world({.sleeping = false});
      add_ground(world);
      for (int row = 0; row < base; ++row)
        for (int i = 0; i < base - row; ++i) add_box(world, {1.02 * i + 0.5 * row, 0.5 + row});
      std::vector<std::uint64_t> hashes;
      for (int i = 0; i < 30; ++i) world.step(1.0 / 60, 4), hashes.push_back(full_hash(world));
      if (first.empty()) first = hashes;
      EXPECT_EQ(hashes, first) << "base " << base;
    });
  }
}

TYPED_TEST(SideBySide, StepsDoNotAllocateOnceWarm) {
  using Real = TypeParam;
  test::at_each_vector_width([&](VectorWidth) {
    BasicWorld<Real> world({.sleeping = false});
    add_ground(world);
    for (int row = 0; row < 12; ++row)
      for (int i = 0; i < 12 - row; ++i) add_box(world, {i + 0.5 * row, 0.5 + row});
    run(world, 60);
    const long before = test::allocations();
    run(world, 100);
    EXPECT_EQ(test::allocations() - before, 0);
  });
}

// Speeds and impulses near the largest numbers, which overflow in products.
TYPED_TEST(SideBySide, HeapsThatAreBlownApartHaveTheSameBitsAtEachWidth) {
  using Real = TypeParam;
  std::uint64_t first = 0;
  test::at_each_vector_width([&](VectorWidth) {
    BasicWorld<Real> world;
    fill_room(world, 5, 120, 0.1);
    run(world, 60);
    const std::vector<BodyId> bodies = world.bodies();
    for (std::size_t i = 2; i < bodies.size(); i += 9) world.set_velocity(bodies[i], {1e12, -1e12});
    run(world, 20);
    if (first == 0) first = full_hash(world);
    EXPECT_EQ(full_hash(world), first);
  });
}

}  // namespace
}  // namespace plumb
