#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <thread>
#include <vector>

#include "tests/world/support.h"

/// Tests that continuous collision does not stop bodies that the pre-solve hook lets pass, nor the common
/// motion of bodies that are inside each other.
namespace plumb {
namespace {

template <class Real>
class PassingThrough : public testing::Test {};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(PassingThrough, Precisions);

TYPED_TEST(PassingThrough, AHookThatAnswersFalseStopsNoFastBody) {
  for (const double speed : {1.6, 2.0, 5.0, 20.0, 200.0}) {
    for (const BodyType type : {BodyType::Static, BodyType::Kinematic, BodyType::Dynamic}) {
      BasicWorld<TypeParam> world({.gravity = {0, 0}, .sleeping = false});
      world.create_body({.type = type}, ShapeDefinition{.geometry = Box{60, 0.1}, .pre_solve = true});
      const BodyId disc = world.create_body({.position = {0, -1.03}, .velocity = {0, speed}},
                                            ShapeDefinition{.geometry = Circle{0.05}});
      world.on_pre_solve([](const ContactReading&) { return false; });
      const int steps = static_cast<int>(3 / speed * 60) + 2;
      run(world, steps);
      EXPECT_NEAR(world.position(disc).y, -1.03 + speed * steps / 60, 1e-4 * (1 + speed)) << speed;
      EXPECT_EQ(world.velocity(disc).y, TypeParam(speed)) << speed;
    }
  }
}

// A step moves the disc by 1/3 m, so that it has no contact before the step of its impact.
TYPED_TEST(PassingThrough, AnImpactFoundWithinAStepIsAskedAboutAtItsPose) {
  BasicWorld<TypeParam> world({.gravity = {0, 0}, .sleeping = false});
  world.create_body({.type = BodyType::Static},
                    ShapeDefinition{.geometry = Box{60, 0.01}, .pre_solve = true});
  world.create_body({.position = {3, -1.1}, .velocity = {0, 20}}, ShapeDefinition{.geometry = Circle{0.05}});
  int calls = 0;
  world.on_pre_solve([&](const ContactReading& contact) {
    ++calls;
    EXPECT_EQ(contact.count, 1);
    EXPECT_NEAR(std::abs(contact.normal.y), 1, 1e-6);
    EXPECT_NEAR(contact.separations[0], 0, 2e-4);  // stops are at kImpactTolerance times the radius
    EXPECT_NEAR(contact.points[0].x, 3, 1e-6);
    EXPECT_NEAR(contact.points[0].y, -0.005, 2e-4);
    EXPECT_NEAR(contact.approach, -20, 1e-5);
    return false;
  });
  run(world, 4);
  EXPECT_EQ(calls, 1);
}

TYPED_TEST(PassingThrough, AOneWayPlatformLetsSmallJumpersRiseToTheirFullHeight) {
  for (const double radius : {0.5, 0.2, 0.1}) {
    for (const double jump : {7.0, 9.0, 12.0}) {
      BasicWorld<TypeParam> world({.sleeping = false});
      const BodyId scenery = world.create_body({.type = BodyType::Static});
      world.create_shape(scenery, {.geometry = Box{40, 2}, .position = {0, -1}});
      const ShapeId platform =
          world.create_shape(scenery, {.geometry = Box{4, 0.2}, .position = {0, 2}, .pre_solve = true});
      const BodyId player =
          world.create_body({.position = {0, radius}, .velocity = {0, jump}}, {.geometry = Circle{radius}});
      world.on_pre_solve([&](const ContactReading& contact) {
        const double up = contact.shape_a == platform ? contact.normal.y : -contact.normal.y;
        return up > 0.5 && world.velocity(player).y <= 0.01;
      });
      double top = 0;
      for (int i = 0; i < 180; ++i) {
        world.step();
        top = std::max(top, world.position(player).y);
      }
      // Between two steps it rises by at most g dt^2 / 8 above the higher one.
      EXPECT_NEAR(top, radius + jump * jump / (2 * kGravity), 1e-3) << radius << " " << jump;
      EXPECT_NEAR(world.position(player).y, 2.1 + radius, 1e-3) << radius << " " << jump;
    }
  }
}

// The ball is above the surface until the hook was asked, and lands as without one: where the path of its
// lowest point meets the surface.
TYPED_TEST(PassingThrough, AHookIsAskedBeforeABodyOverlaps) {
  const auto land = [](bool asks, double size, double height, double slope) {
    BasicWorld<TypeParam> world({.gravity = {0, 0}, .sleeping = false});
    world.create_body({.type = BodyType::Static, .position = {0, -0.5}},
                      {.geometry = Box{40, 1}, .pre_solve = asks});
    const BodyId ball =
        world.create_body({.position = {0, size * height}, .velocity = {slope * size, -36 * size}},
                          {.geometry = Circle{size / 2}, .material = {.friction = 0}});
    bool asked = false;
    world.on_pre_solve([&](const ContactReading&) { return asked = true; });
    double lowest = 1;
    for (int i = 0; i < 12; ++i) {
      world.step();
      lowest = std::min(lowest, (world.position(ball).y - size / 2) / size);
      if (world.position(ball).y < size / 2 - 1e-3 * size) {
        EXPECT_TRUE(asked || !asks) << height;
      }
    }
    EXPECT_EQ(asked, asks);
    EXPECT_NEAR(world.position(ball).x, slope * size / 5, 1e-4 * size) << height;
    return lowest;
  };
  for (const double size : {0.2, 1.0}) {
    for (int phase = 0; phase < 50; ++phase) {
      for (const double slope : {0.0, 10.0}) {
        EXPECT_GT(land(true, size, 1.4 + 0.02 * phase, slope), -1e-3) << size << " " << phase;
        EXPECT_GT(land(false, size, 1.4 + 0.02 * phase, slope), -1e-3) << size << " " << phase;
      }
    }
  }
}

// Boxes that bounce leave a surface whose hook says yes with what they leave any other with.
TYPED_TEST(PassingThrough, AHookThatAnswersTrueChangesNoImpact) {
  for (int number = 0; number < 100; ++number) {
    const auto fly = [&](bool asks) {
      BasicWorld<TypeParam> world({.sleeping = false});
      const Material material{.friction = 0.3, .restitution = 0.1 * (number % 10)};
      world.create_body({.type = BodyType::Static, .position = {0, -0.5}},
                        {.geometry = Box{40, 1}, .material = material, .pre_solve = asks});
      const BodyId box = world.create_body({.position = {0, 1.5 + 0.02 * number},
                                            .angle = 0.05 * number,
                                            .velocity = {1, -3.0 - number % 7 * 8},
                                            .angular_velocity = 0.1 * number - 5},
                                           {.geometry = Box{1, 0.5}, .material = material});
      bool asked = false;
      world.on_pre_solve([&](const ContactReading&) { return asked = true; });
      for (int i = 0; i < 60 && !(world.velocity(box).y > -1); ++i) world.step();
      EXPECT_EQ(asked, asks) << number;
      return std::array<double, 6>{world.position(box).x,
                                   world.position(box).y,
                                   world.angle(box),
                                   static_cast<double>(world.velocity(box).x),
                                   static_cast<double>(world.velocity(box).y),
                                   static_cast<double>(world.angular_velocity(box))};
    };
    EXPECT_EQ(fly(true), fly(false)) << number;
  }
}

// The hook reads the bodies as they are at the impact, not as they would be at the step's end.
TYPED_TEST(PassingThrough, AHookReadsTheBodiesAtTheImpact) {
  for (const double spin : {0.0, 3.0}) {
    BasicWorld<TypeParam> world({.sleeping = false});
    world.create_body({.type = BodyType::Static},
                      ShapeDefinition{.geometry = Box{60, 0.01}, .pre_solve = true});
    const BodyId disc =
        world.create_body({.position = {0, 2.03}, .velocity = {0, -30}, .angular_velocity = spin},
                          ShapeDefinition{.geometry = Circle{0.05}});
    int calls = 0;
    world.on_pre_solve([&](const ContactReading& contact) {
      if (++calls > 1) return true;
      // v^2 = v0^2 + 2 g d, with d down to where it touches.
      const double fall = 2.03 - 0.055, speed = std::sqrt(900 + 2 * kGravity * fall),
                   time = (speed - 30) / kGravity;
      EXPECT_NEAR(world.position(disc).y, 0.055, 1e-4);
      EXPECT_NEAR(world.box(disc).lower.y, 0.005, 1e-4);
      EXPECT_NEAR(world.velocity(disc).y, -speed, 2e-3);
      EXPECT_NEAR(contact.approach, -speed, 2e-3);
      EXPECT_NEAR(world.angle(disc), spin * time, 1e-3);
      return true;
    });
    run(world, 10);
    EXPECT_GE(calls, 1);
  }
}

// A ball that lands faster than its contact can see must still be held from above.
TYPED_TEST(PassingThrough, AHookThatAnswersTrueHoldsFastBodies) {
  for (const double speed : {5.0, 50.0, 500.0}) {
    BasicWorld<TypeParam> world({.gravity = {0, 0}, .sleeping = false});
    world.create_body({.type = BodyType::Static},
                      ShapeDefinition{.geometry = Box{60, 0.01}, .pre_solve = true});
    const BodyId disc = world.create_body({.position = {0, 2.03}, .velocity = {0, -speed}},
                                          ShapeDefinition{.geometry = Circle{0.05}});
    world.on_pre_solve([](const ContactReading&) { return true; });
    run(world, 120);
    EXPECT_NEAR(world.position(disc).y, 0.055, 1e-3) << speed;
  }
}

// An exception of the hook ends the step before anything has moved, in continuous collision too; the next
// step acts as if there had been none.
TYPED_TEST(PassingThrough, AHookThatThrowsLeavesFastBodiesWhereTheyWere) {
  struct Boom {};
  for (const double speed : {5.0, 50.0, 500.0}) {
    BasicWorld<TypeParam> world({.gravity = {0, 0}, .sleeping = false}),
        twin({.gravity = {0, 0}, .sleeping = false});
    std::vector<BodyId> discs;
    for (BasicWorld<TypeParam>* each : {&world, &twin}) {
      each->create_body({.type = BodyType::Static},
                        ShapeDefinition{.geometry = Box{60, 0.01}, .pre_solve = true});
      discs.push_back(
          each->create_body({.position = {0, 2.03}, .velocity = {1, -speed}, .angular_velocity = 3},
                            ShapeDefinition{.geometry = Circle{0.05}}));
    }
    bool throws = true;
    int thrown = 0;
    world.on_pre_solve([&](const ContactReading&) -> bool {
      if (throws) throw Boom();
      return true;
    });
    twin.on_pre_solve([](const ContactReading&) { return true; });
    for (int i = 0; i < 120; ++i) {
      const std::uint64_t before = world.hash();
      world.apply_force(discs[0], {0, -1}), twin.apply_force(discs[1], {0, -1});
      try {
        world.step();
      } catch (const Boom&) {
        ++thrown, throws = false;
        EXPECT_EQ(world.hash(), before) << speed;
        world.step();
      }
      twin.step();
    }
    EXPECT_GT(thrown, 0) << speed;
    EXPECT_NEAR(world.position(discs[0]).x, twin.position(discs[1]).x, 1e-4) << speed;
    EXPECT_NEAR(world.position(discs[0]).y, twin.position(discs[1]).y, 1e-4) << speed;
  }
}

TYPED_TEST(PassingThrough, TheHookIsCalledOnTheCallingThread) {
  const auto hash_with = [](int threads) {
    BasicWorld<TypeParam> world({.sleeping = false, .threads = threads});
    world.create_body({.type = BodyType::Static},
                      ShapeDefinition{.geometry = Box{900, 0.05}, .pre_solve = true});
    for (int i = 0; i < 400; ++i)
      world.create_body({.position = {0.5 * i - 100, 1 + 0.01 * i}, .velocity = {0, -20 - 0.1 * i}},
                        ShapeDefinition{.geometry = Circle{0.1}});
    const std::thread::id caller = std::this_thread::get_id();
    world.on_pre_solve([&](const ContactReading& contact) {
      EXPECT_EQ(std::this_thread::get_id(), caller);
      return std::fmod(contact.points[0].x + 100, 2) < 1;
    });
    run(world, 60);
    return world.hash();
  };
  EXPECT_EQ(hash_with(1), hash_with(2));
}

Polygon pentagon() { return {{{-0.5, -0.5}, {0.5, -0.5}, {0.7, 0}, {0, 0.6}, {-0.7, 0}}}; }

template <class Real>
Vec2d common_centre(const BasicWorld<Real>& world, const std::vector<BodyId>& bodies) {
  double mass = 0;
  Vec2d sum{};
  for (const BodyId body : bodies) mass += world.mass(body), sum += world.mass(body) * world.centre(body);
  return (1 / mass) * sum;
}

// In steps of dt velocities gain g dt before positions move: within g t dt / 2 of g t^2 / 2.
TYPED_TEST(PassingThrough, BodiesCreatedInsideEachOtherFallTogether) {
  BasicWorld<TypeParam> world;
  const std::vector<BodyId> pair{world.create_body({}, ShapeDefinition{.geometry = Circle{0.5}}),
                                 world.create_body({}, ShapeDefinition{.geometry = pentagon()})};
  const double start = common_centre(world, pair).y;
  run(world, 120);
  EXPECT_NEAR(common_centre(world, pair).y - start, -kGravity * 4 / 2, kGravity * 2 / 120);
}

TYPED_TEST(PassingThrough, BodiesInsideEachOtherKeepTheirCommonMotion) {
  for (const double speed : {0.1, 1.0, 10.0, 100.0}) {
    for (const double angle : {0.0, 0.3}) {
      BasicWorld<TypeParam> world({.gravity = {0, 0}});
      const ShapeDefinition shape{.geometry = pentagon()};
      const std::vector<BodyId> pair{
          world.create_body({.velocity = {speed, 0}}, shape),
          world.create_body({.position = {-0.024, -0.11}, .angle = -1.476 - angle, .velocity = {speed, 0}},
                            shape)};
      const Vec2d start = common_centre(world, pair);
      run(world, 120);
      const Vec2d moved = common_centre(world, pair) - start;
      EXPECT_NEAR(moved.x, 2 * speed, 1e-3 * (1 + speed));
      EXPECT_NEAR(moved.y, 0, 1e-3 * (1 + speed));
    }
  }
}

TYPED_TEST(PassingThrough, JoinedBodiesInsideEachOtherFallFreely) {
  BasicWorld<TypeParam> world;
  const std::vector<BodyId> pair{world.create_body({}, ShapeDefinition{.geometry = Circle{0.5}}),
                                 world.create_body({}, ShapeDefinition{.geometry = pentagon()})};
  world.create_joint(pair[0], pair[1], {.kind = RevoluteDefinition{}, .collide = true});
  const double start = common_centre(world, pair).y;
  run(world, 60);
  EXPECT_NEAR(common_centre(world, pair).y - start, -kGravity / 2, kGravity / 60);
}

}  // namespace
}  // namespace plumb
