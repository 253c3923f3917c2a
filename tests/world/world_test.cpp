#include "engine/world/world.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/scene/error.h"
#include "tests/world/allocations.h"
#include "tests/world/golden.h"
#include "tests/world/ragdoll.h"
#include "tests/world/support.h"
#include "tests/world/threadings.h"
#include "tests/world/vector_widths.h"

namespace plumb {
namespace {

// A pile of all kinds of shapes with joints among them, that falls into a box.
void add_pile(World& world, int count) {
  add_ground(world);
  BodyDefinition wall;
  wall.type = BodyType::Static;
  wall.position = {-6, 5};
  world.create_body(wall, ShapeDefinition{.geometry = Box{1, 30}});
  wall.position = {6, 5};
  world.create_body(wall, ShapeDefinition{.geometry = Box{1, 30}});
  BodyId last;
  for (int i = 0; i < count; ++i) {
    const Vec2d at{-4 + 1.3 * (i % 7), 1 + 1.1 * (i / 7)};
    const ShapeGeometry kinds[] = {Circle{0.4}, Box{0.8, 0.6}, Capsule{{-0.3, 0}, {0.3, 0}, 0.2},
                                   Polygon{{{-0.4, -0.3}, {0.5, -0.3}, {0, 0.5}}, 0.05}};
    BodyDefinition body;
    body.position = at;
    body.angle = 0.3 * i;
    body.velocity = {0.5 * (i % 3), -1};
    const BodyId added = world.create_body(
        body, ShapeDefinition{.geometry = kinds[i % 4], .material = {.restitution = 0.1 * (i % 3)}});
    if (i % 5 == 4) {
      world.create_joint(last, added, {.kind = DistanceDefinition{.length = 1.2, .spring = Spring{4, 0.5}}});
    } else if (i % 7 == 6) {
      world.create_joint(last, added,
                         {.kind = RevoluteDefinition{.anchor_a = {0.7, 0}, .anchor_b = {-0.7, 0}}});
    }
    last = added;
  }
}

TEST(World, AFallingPileHasOneHashEverywhere) {
  test::at_each_vector_width([](VectorWidth) {
    World world(without_sleep());
    add_pile(world, 60);
    add_ragdoll(world, {.at = {0, 14}});
    run(world, 1000);
    test::expect_golden("falling_pile", world.hash());
  });
}

TEST(World, AFallingPileHasOneHashEverywhereForEachNumberOfThreads) {
  for (const int threads : {2, 3, 8}) {
    World world(without_sleep());
    test::share_all(world, threads, LoopOrder::Shuffled);
    add_pile(world, 60);
    add_ragdoll(world, {.at = {0, 14}});
    run(world, 1000);
    test::expect_golden("falling_pile", world.hash());
  }
}

TEST(World, StepsDoNotAllocateOnceWarm) {
  World world(without_sleep());
  add_pile(world, 60);
  run(world, 600);
  const long before = test::allocations();
  run(world, 200);
  EXPECT_EQ(test::allocations() - before, 0);
}

TEST(World, ATipOfAThousandOnTenLinksDoesNotStretch) {
  World world(without_sleep());
  BodyDefinition body;
  body.type = BodyType::Static;
  BodyId last = world.create_body(body);
  std::vector<JointId> joints;
  for (int i = 0; i < 10; ++i) {
    body = {};
    body.position = {0, -0.5 - i};
    const BodyId link = world.create_body(
        body,
        ShapeDefinition{.geometry = Box{0.25, 1}, .density = i == 9 ? 4000.0 : 4.0, .filter = {.mask = 0}});
    joints.push_back(world.create_joint(
        last, link, {.kind = RevoluteDefinition{.anchor_a = {0, i == 0 ? 0 : -0.5}, .anchor_b = {0, 0.5}}}));
    last = link;
  }
  double worst = 0;
  for (int i = 0; i < 600; ++i) {
    world.step();
    double gaps = 0;
    for (const JointId joint : joints) gaps += world.read(joint).linear_error;
    worst = std::max(worst, gaps);
  }
  EXPECT_LT(worst, 1e-5);  // m of 10 m; measured 1e-6
  EXPECT_NEAR(world.read(joints[0]).force, (9 * 1 + 1000) * kGravity, 1e-3 * 1009 * kGravity);
}

TEST(World, JointsBreakAtTheirForce) {
  for (const double strength : {50.0, 200.0}) {
    World world;
    BodyDefinition still;
    still.type = BodyType::Static;
    const BodyId hook = world.create_body(still);
    const BodyId load = add_box(world, {0, -1}, 10);  // 98.1 N
    const JointId rope =
        world.create_joint(hook, load, {.kind = DistanceDefinition{.length = 1}, .break_force = strength});
    int broken = 0;
    for (int i = 0; i < 120; ++i) {
      world.step();
      for (const JointEvent& event : world.events().broken) broken += event.joint == rope;
    }
    EXPECT_EQ(broken, strength < 98 ? 1 : 0);
    EXPECT_EQ(world.valid(rope), strength > 98);
    EXPECT_EQ(world.position(load).y < -2, strength < 98);
  }
}

TEST(World, JointsBreakAtTheirTorque) {
  for (const double strength : {50.0, 200.0}) {
    World world;
    const BodyId wall = world.create_body({.type = BodyType::Static});
    const BodyId beam = add_box(world, {1, 0}, 10, 2, 0.5);  // 98.1 N at an arm of 1 m
    const JointId weld = world.create_joint(
        wall, beam, {.kind = WeldDefinition{.anchor_b = {-1, 0}}, .break_torque = strength});
    for (int i = 0; i < 120; ++i) world.step();
    EXPECT_EQ(world.valid(weld), strength > 98.1) << strength << " N m";
  }
}

TEST(World, JoinedBodiesTouchOnlyIfAsked) {
  for (const bool collide : {false, true}) {
    World world(weightless());
    const BodyId a = add_box(world, {0, 0}), b = add_box(world, {1.5, 0});
    world.create_joint(
        a, b,
        {.kind = DistanceDefinition{.length = 1, .spring = Spring{0.5, 0}, .range = Range{0, 9}},
         .collide = collide});
    world.apply_impulse(b, {-3, 0});
    double nearest = 9;
    for (int i = 0; i < 60; ++i) {
      world.step();
      nearest = std::min(nearest, std::abs(world.position(b).x - world.position(a).x));
    }
    EXPECT_EQ(nearest > 0.98, collide) << nearest;
  }
}

TEST(Handles, KnowWhenWhatTheyNameIsGone) {
  World world;
  const BodyId first = add_box(world, {0, 0});
  const ShapeId shape = world.shapes(first)[0];
  world.destroy(first);
  EXPECT_FALSE(world.valid(first));
  EXPECT_FALSE(world.valid(shape));
  const BodyId second = add_box(world, {0, 0});
  EXPECT_EQ(second.index, first.index);
  EXPECT_NE(second, first);
  const auto refused = [](auto&& call) {
    try {
      call();
      ADD_FAILURE() << "was accepted";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), Error::Kind::Name) << error.what();
      EXPECT_EQ(error.field(), "handle");
    }
  };
  refused([&] { world.position(first); });
  refused([&] { world.apply_force(first, {1, 0}); });
  refused([&] { world.destroy(shape); });
  refused([&] { world.create_joint(first, second, {}); });
  refused([&] { world.position(BodyId{}); });
  refused([&] { world.read(JointId{}); });
}

TEST(Handles, MisuseIsATypedErrorAndChangesNothing) {
  World world;
  const BodyId a = add_box(world, {0, 0}), b = add_box(world, {2, 0});
  const std::uint64_t before = world.hash();
  const double nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
  EXPECT_THROW(world.step(0), Error);
  EXPECT_THROW(world.step(-1), Error);
  EXPECT_THROW(world.step(nan), Error);
  EXPECT_THROW(world.step(1.0 / 60, 0), Error);
  EXPECT_THROW(world.step(1.0 / 60, 1001), Error);
  EXPECT_THROW(world.set_velocity(a, {nan, 0}), Error);
  EXPECT_THROW(world.set_position(a, {infinity, 0}, 0), Error);
  EXPECT_THROW(world.apply_impulse(a, {0, nan}), Error);
  EXPECT_THROW(world.apply_force(a, {0, 0}, {nan, 0}), Error);
  EXPECT_THROW(world.set_mass(a, {-1, {}, 1}), Error);
  EXPECT_THROW(world.set_damping(a, -1, 0), Error);
  EXPECT_THROW(world.set_gravity({nan, 0}), Error);
  EXPECT_THROW(world.create_joint(a, a, {}), Error);
  EXPECT_THROW(world.create_joint(a, b, {.kind = DistanceDefinition{.length = -1}}), Error);
  EXPECT_THROW(world.create_joint(a, b, {.break_force = nan}), Error);
  EXPECT_THROW(world.create_chain(a, {.points = {{0, 0}}}), Error);
  EXPECT_EQ(world.hash(), before);
  EXPECT_EQ(world.counts().joints, 0);
  EXPECT_EQ(world.counts().bodies, 2);
  world.step();
}

TEST(Handles, AStateThatIsNotFiniteIsReported) {
  World world({.quarantine = false});
  BodyDefinition definition;
  definition.name = "rocket";
  const BodyId body = world.create_body(definition, ShapeDefinition{});
  for (int i = 0; i < 100; ++i) world.apply_force(body, {1e12, 0});
  try {
    for (int i = 0; i < 1000; ++i) {
      for (int k = 0; k < 100; ++k) world.apply_force(body, {1e12, 0}), world.apply_impulse(body, {1e12, 0});
      for (int k = 0; k < 40; ++k) world.set_mass(body, {1e-12, {}, 1});
      world.step(1e12, 1);
    }
    ADD_FAILURE() << "nothing was reported";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::Run);
    EXPECT_EQ(error.subject(), "body 'rocket'");
  }
}

}  // namespace
}  // namespace plumb
