#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "engine/world/snapshot.h"
#include "engine/world/state_hash.h"
#include "tests/world/heaps.h"
#include "tests/world/support.h"

// Checks that bodies which move slowly, or begin to move, do not fall asleep, and that those at rest do.
// Expected values are closed forms; sizes are from 0.1 to 100 m.
namespace plumb {
namespace {

template <class Real>
class SlowMotion : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(SlowMotion, Reals);

constexpr double kSizes[] = {0.1, 1, 5, 30, 100};

template <class Real>
BodyId add_fixed(BasicWorld<Real>& world) {
  return world.create_body({.type = BodyType::Static});
}

/// Ground whose top is at y = 0, wide for bodies of `size`, m.
template <class Real>
BodyId add_wide_ground(BasicWorld<Real>& world, double size, Material material = {}, double slope = 0) {
  return world.create_body(
      {.type = BodyType::Static, .angle = slope},
      {.geometry = Box{200 * size, 10 * size}, .position = {0, -5 * size}, .material = material});
}

TYPED_TEST(SlowMotion, FreeBodiesFallFromRest) {
  for (const double size : kSizes) {
    for (const double g : {1e-4, 0.01, 1.0, 9.81}) {
      BasicWorld<TypeParam> world({.gravity = {0, -g}});
      const BodyId box = add_box(world, {0, 0}, 1, size, size);
      run(world, 120);
      EXPECT_NEAR(world.position(box).y, -2 * g, 2e-5 * g) << size << " m, " << g << " m/s^2";
    }
  }
}

// Nothing holds a free body, so no speed counts as rest.
TYPED_TEST(SlowMotion, FreeBodiesFallWhateverTheUsersSpeed) {
  BasicWorld<TypeParam> world({.thresholds = {.sleep = 100}});
  const BodyId box = add_box(world, {0, 0});
  run(world, 120);
  EXPECT_NEAR(world.position(box).y, -2 * kGravity, 1e-4);
}

TYPED_TEST(SlowMotion, FreeBodiesWithoutWeightFallAsleep) {
  BasicWorld<TypeParam> world;
  const ShapeDefinition box{.geometry = Box{1, 1}};
  const std::vector<BodyId> bodies{world.create_body({.position = {0, 0}, .gravity_scale = 0}, box),
                                   world.create_body({.position = {3, 0}, .lock_y = true}, box),
                                   world.create_body({.type = BodyType::Kinematic, .position = {6, 0}}, box)};
  run(world, 60);
  for (const BodyId body : bodies) EXPECT_FALSE(world.awake(body));
}

TYPED_TEST(SlowMotion, BodiesDriftOn) {
  for (const double size : kSizes) {
    BasicWorld<TypeParam> world(weightless());
    const double speed = 0.01 * size;
    const BodyId box = add_body(world, {0, 0}, {.geometry = Box{size, size}}, {speed, 0});
    run(world, 600);
    EXPECT_NEAR(world.position(box).x, 10 * speed, 1e-4 * speed) << size << " m";
  }
}

TYPED_TEST(SlowMotion, WeakThrustMovesBodies) {
  for (const double size : kSizes) {
    BasicWorld<TypeParam> world(weightless());
    const BodyId box = add_box(world, {0, 0}, 1, size, size);
    const double acceleration = 0.03 * size;
    for (int i = 0; i < 300; ++i) {
      world.apply_force(box, {acceleration * world.mass(box), 0});
      world.step();
    }
    EXPECT_NEAR(world.position(box).x, acceleration * 25 / 2, 1e-3 * acceleration) << size << " m";
  }
}

TYPED_TEST(SlowMotion, BeltsCarryCrates) {
  for (const double size : kSizes) {
    BasicWorld<TypeParam> world;
    const double speed = 0.01 * size;
    add_wide_ground(world, size, {.surface_speed = speed});
    const BodyId crate = add_box(world, {0, size / 2}, 1, size, size);
    run(world, 600);
    // Friction brings the crate to the belt's speed in v / (mu g), at most 0.2 s.
    EXPECT_NEAR(world.position(crate).x, 10 * speed, 0.15 * speed) << size << " m";
  }
}

TYPED_TEST(SlowMotion, MotorsTurnAndLiftSlowly) {
  for (const double size : kSizes) {
    BasicWorld<TypeParam> world;
    const BodyId fixed = add_fixed(world);
    const BodyId hand = add_box(world, {size / 2, 0}, 1, size, 0.1 * size);
    const BodyId cage = add_box(world, {3 * size, 0}, 1, size, size);
    const double turning = 0.01, lifting = 0.01 * size;
    world.create_joint(
        fixed, hand,
        {.kind = RevoluteDefinition{.anchor_b = {-size / 2, 0},
                                    .motor = Motor{turning, 10 * world.mass(hand) * kGravity * size}}});
    world.create_joint(
        fixed, cage,
        {.kind = PrismaticDefinition{.anchor_a = {3 * size, 0},
                                     .axis = {0, 1},
                                     .motor = Motor{lifting, 10 * world.mass(cage) * kGravity}}});
    run(world, 600);
    EXPECT_NEAR(world.angle(hand), 10 * turning, 0.2 * turning) << size << " m";
    EXPECT_NEAR(world.position(cage).y, 10 * lifting, 0.2 * lifting) << size << " m";
  }
}

// A slab whose centre of mass is past the edge of a table by 1 % of its length turns about the edge.
TYPED_TEST(SlowMotion, SlabsPastAnEdgeTip) {
  for (const double length : {0.4, 4.0, 20.0, 100.0}) {
    BasicWorld<TypeParam> world;
    world.create_body({.type = BodyType::Static, .position = {-5 * length, -5 * length}},
                      {.geometry = Box{10 * length, 10 * length}});
    const double past = 0.01 * length, height = 0.25 * length;
    const BodyId slab = add_box(world, {past, height / 2}, 1, length, height);
    const double unit = std::sqrt(length / kGravity);
    run(world, static_cast<int>(20 * unit * 60));
    EXPECT_LT(world.position(slab).y, 0) << length << " m";
  }
}

TYPED_TEST(SlowMotion, DiscsRollDownSlightSlopes) {
  for (const double size : kSizes) {
    constexpr double kSlope = 0.005;
    BasicWorld<TypeParam> world;
    add_wide_ground(world, std::max(size, 5.0), {}, -kSlope);
    const double radius = size / 2;
    const BodyId disc =
        add_body(world, {radius * std::sin(kSlope), radius * std::cos(kSlope)}, {.geometry = Circle{radius}});
    run(world, 300);
    const double speed = 5 * kGravity * std::sin(kSlope) * 2 / 3;
    EXPECT_NEAR(std::sqrt(length_squared(world.velocity(disc))), speed, 0.02 * speed) << size << " m";
  }
}

// A bar that swings by 0.02 rad is slow near its turning points, for seconds if it is long.
TYPED_TEST(SlowMotion, PendulumsSwingOn) {
  for (const double length : kSizes) {
    BasicWorld<TypeParam> world;
    constexpr double kAngle = 0.02;
    const BodyId fixed = add_fixed(world);
    const BodyId bar = world.create_body(
        {.position = {std::sin(kAngle) * length / 2, -std::cos(kAngle) * length / 2}, .angle = kAngle},
        {.geometry = Box{length / 10, length}});
    world.create_joint(fixed, bar, {.kind = RevoluteDefinition{.anchor_b = {0, length / 2}}});
    const double inertia_by_mass = length * length * (1.0 / 3 + 0.01 / 12);
    const double half_period = std::acos(-1) * std::sqrt(inertia_by_mass / (kGravity * length / 2));
    constexpr int kSteps = 1000;
    for (int i = 0; i < kSteps; ++i) world.step(half_period / 50);
    EXPECT_NEAR(world.angle(bar), kAngle, 0.1 * kAngle) << length << " m";  // after ten periods
  }
}

TYPED_TEST(SlowMotion, RestingBodiesFallAsleepAtAnySizeAndGravity) {
  for (const double size : kSizes) {
    for (const double g : {0.01, 1.0, 9.81, 100.0}) {
      BasicWorld<TypeParam> world({.gravity = {0, -g}});
      add_wide_ground(world, size);
      const BodyId box = add_box(world, {0, size / 2}, 1, size, size);
      const BodyId disc = add_body(world, {3 * size, size / 2}, {.geometry = Circle{size / 2}});
      run(world, 60);
      EXPECT_FALSE(world.awake(box) || world.awake(disc)) << size << " m, " << g << " m/s^2";
    }
  }
}

TEST(SlowMotions, PyramidsFallAsleep) {
  World world;
  add_ground(world);
  add_pyramid(world, 20);
  run(world, 360);
  EXPECT_EQ(world.counts().awake, 0);
}

// A speed that the user sets is what counts as rest: slower bodies sleep, faster ones do not.
TYPED_TEST(SlowMotion, TheUsersSpeedDecides) {
  for (const double speed : {0.01, 0.1, 1.0}) {
    BasicWorld<TypeParam> world({.gravity = {0, 0}, .thresholds = {.sleep = 0.3}});
    const BodyId box = add_body(world, {0, 0}, {.geometry = Box{1, 1}}, {speed, 0});
    run(world, 120);
    EXPECT_EQ(world.awake(box), speed > 0.3) << speed << " m/s";
  }
}

// The pose in which the period of rest began belongs to the state: restored in the middle of a period, a body
// that is just too fast for sleep stays awake in the same steps.
TYPED_TEST(SlowMotion, SnapshotsKeepThePeriodOfRest) {
  const double speed = 0.006 * std::sqrt(0.5);  // 0.0024 extents in 0.4 s, 0.003 in 0.5 s
  BasicWorld<TypeParam> world(weightless()), restored;
  const BodyId box = add_body(world, {5, 0}, {.geometry = Box{1, 1}}, {speed, 0});
  run(world, 20);
  restore(restored, save(world));
  for (int i = 0; i < 120; ++i) {
    world.step(), restored.step();
    ASSERT_EQ(full_hash(world), full_hash(restored)) << i;
  }
  EXPECT_TRUE(world.awake(box));
  EXPECT_NEAR(world.position(box).x, 5 + speed * 140 / 60, 1e-6);
}

TEST(SlowMotions, WorldsWithoutSleepKeepNoPeriods) {
  World on, off(without_sleep());
  for (World* world : {&on, &off}) {
    for (int i = 0; i < 10; ++i) add_box(*world, {3.0 * i, 0});
    world->step();
  }
  EXPECT_EQ(save(on).size() - save(off).size(), 10 * 3 * sizeof(float));
}

}  // namespace
}  // namespace plumb
