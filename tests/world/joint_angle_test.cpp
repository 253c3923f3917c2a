#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "engine/simulation/simulation.h"
#include "engine/world/add_scene.h"
#include "engine/world/snapshot.h"
#include "tests/world/solver_scenes.h"

// The angle of a joint: where it is born, and how its whole turns are counted from there.
namespace plumb {
namespace {

constexpr double kPi = 3.14159265358979323846;

template <class Real>
class JointAngles : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(JointAngles, Reals);

// rad: what a rotation may be off by.
template <class Real>
constexpr double kRounding = sizeof(Real) == 4 ? 2e-5 : 1e-9;

int cases(int usual) {
  const char* times = std::getenv("PLUMB_PROPERTY_CASES");
  return times == nullptr ? usual : usual * std::atoi(times);
}

// Every kind that has an angle, such that it is 0 where b stands at `reference` from a.
std::vector<std::pair<std::string, JointKind>> kinds_at(double reference) {
  const Spring spring{3, 0.7};
  return {{"hinge", RevoluteDefinition{.reference_angle = reference}},
          {"limited hinge", RevoluteDefinition{.reference_angle = reference, .limits = Range{-0.1, 0.1}}},
          {"driven hinge", RevoluteDefinition{.reference_angle = reference, .motor = Motor{0, 5}}},
          {"sprung hinge", RevoluteDefinition{.reference_angle = reference, .spring = spring}},
          {"slider", PrismaticDefinition{.reference_angle = reference}},
          {"weld", WeldDefinition{.reference_angle = reference}},
          {"soft weld", WeldDefinition{.reference_angle = reference, .angular_spring = spring}},
          {"motor", MotorDefinition{.target_angle = reference, .max_force = 100, .max_torque = 100}}};
}

template <class Real>
BodyId add_door(BasicWorld<Real>& world, double angle, double spin = 0) {
  return world.create_body({.angle = angle, .angular_velocity = spin, .may_sleep = false},
                           {.geometry = Box{3, 0.4}});
}

// Whatever turns both bodies have come: the joint is put together as it is told to be, and nothing moves.
TYPED_TEST(JointAngles, AreBornAtTheNearestTurn) {
  std::mt19937 draw(20);
  std::uniform_real_distribution<double> anywhere(-40, 40), nearby(-0.09, 0.09);
  for (int i = 0; i < cases(12); ++i) {
    const double angle_a = anywhere(draw), angle_b = anywhere(draw), off = nearby(draw);
    for (const auto& [name, kind] : kinds_at(angle_b - angle_a - off)) {
      BasicWorld<TypeParam> world(weightless());
      const BodyId a = add_door(world, angle_a), b = add_door(world, angle_b);
      const JointId joint = world.create_joint(a, b, {.kind = kind});
      ASSERT_NEAR(world.read(joint).angle, off, kRounding<TypeParam>) << name << " " << i;
      run(world, 60);
      ASSERT_LT(std::abs(world.angle(b) - world.angle(a) - (angle_b - angle_a)), 0.1) << name << " " << i;
      ASSERT_LT(std::abs(world.read(joint).angle), std::abs(off) + 1e-3) << name << " " << i;
    }
  }
}

// Limits come first: a door between 4 and 6 rad that stands at 5.
TYPED_TEST(JointAngles, AreBornAtTheTurnThatLimitsAllow) {
  struct Case {
    double angle;
    Range limits;
    double born;
  };
  const Case table[] = {{5, {4, 6}, 5},
                        {5 - 4 * kPi, {4, 6}, 5},
                        {4, {-0.1, 5}, 4},
                        {-3, {1, 4}, 2 * kPi - 3},
                        {0.5, {1, 4}, 0.5},
                        {-0.005, {0, 2 * kPi}, -0.005},
                        {-3, {2, 3}, 2 * kPi - 3},
                        {30, {-20, 20}, 30 - 10 * kPi},
                        {1, {12, 14}, 1 + 4 * kPi}};
  for (const Case& c : table) {
    BasicWorld<TypeParam> world(weightless());
    const BodyId ground = world.create_body({.type = BodyType::Static});
    const JointId joint = world.create_joint(ground, add_door(world, c.angle),
                                             {.kind = RevoluteDefinition{.limits = c.limits}});
    EXPECT_NEAR(world.read(joint).angle, c.born, kRounding<TypeParam>) << c.angle;
    world.step();
    const double passed = std::max({c.limits.lower - c.born, c.born - c.limits.upper, 0.0});
    EXPECT_NEAR(world.read(joint).angle, c.born, passed + 0.01) << c.angle;
  }
}

// A pose tells of no turns: those that were counted stay, wherever the body is put.
TYPED_TEST(JointAngles, StayAtTheNearestTurnWhenBodiesArePutElsewhere) {
  for (const double spin : {8.0, -8.0, 40.0}) {
    for (const double by : {0.0, 1.5, -1.5, 4 * kPi}) {
      BasicWorld<TypeParam> world(weightless());
      const BodyId ground = world.create_body({.type = BodyType::Static}), door = add_door(world, 0, spin);
      const JointId joint =
          world.create_joint(ground, door, {.kind = RevoluteDefinition{.limits = Range{-200, 200}}});
      run(world, 60);
      const double before = world.read(joint).angle;
      ASSERT_NEAR(before, spin, 1e-3);
      world.set_position(door, world.position(door), world.angle(door) + by);
      const double jump = by > kPi ? 0 : by;
      EXPECT_NEAR(world.read(joint).angle, before + jump, 10 * kRounding<TypeParam>);
      world.step();
      EXPECT_NEAR(world.read(joint).angle, before + jump + spin / 60, 1e-3) << spin << " " << by;
    }
  }
}

TYPED_TEST(JointAngles, AreBornAnewWithAnotherReference) {
  for (const double spin : {8.0, -11.0}) {
    for (const double start : {0.0, 9.5}) {
      const auto turned = [&](const JointKind& first) {
        BasicWorld<TypeParam> world(weightless());
        const BodyId ground = world.create_body({.type = BodyType::Static}),
                     door = add_door(world, start, spin);
        const JointId joint = world.create_joint(ground, door, {.kind = first});
        run(world, 60);
        const double now = world.angle(door);
        ASSERT_NEAR(now, start + spin, 1e-3);
        world.set_angular_velocity(door, 0);
        for (const auto& [name, kind] : kinds_at(now)) {
          world.change(joint, kind);
          EXPECT_NEAR(world.read(joint).angle, 0, kRounding<TypeParam>) << name;
          run(world, 20);
          EXPECT_NEAR(world.angle(door), now, 1e-3) << name;
        }
      };
      turned(RevoluteDefinition{});
      turned(RevoluteDefinition{.limits = Range{-50, 50}});
    }
  }
}

// Limits that come later find the angle as it was counted, or, where they exclude that, at the turn that is
// nearest to them.
TYPED_TEST(JointAngles, KeepTheirTurnsUnderLimitsThatComeLater) {
  BasicWorld<TypeParam> world(weightless());
  const BodyId ground = world.create_body({.type = BodyType::Static}), door = add_door(world, 0, 8);
  const JointId joint =
      world.create_joint(ground, door, {.kind = RevoluteDefinition{.limits = Range{-20, 20}}});
  run(world, 60);
  world.set_angular_velocity(door, 0);
  const double angle = world.read(joint).angle;
  world.change(joint, RevoluteDefinition{.limits = Range{angle - 0.1, angle + 0.1}});
  run(world, 10);
  EXPECT_NEAR(world.read(joint).angle, angle, 1e-4);
  world.change(joint, RevoluteDefinition{.motor = Motor{0, 1}});
  run(world, 10);
  EXPECT_NEAR(world.read(joint).angle, angle, 1e-4);
  world.change(joint, RevoluteDefinition{.limits = Range{1.7, 2}});
  run(world, 10);
  EXPECT_NEAR(world.read(joint).angle, angle - 2 * kPi, 1e-4);
  EXPECT_NEAR(world.angle(door), angle, 1e-4);
}

// Turns are part of a snapshot, before the first step and after many.
TYPED_TEST(JointAngles, ComeBackWithSnapshots) {
  BasicWorld<TypeParam> world(weightless());
  const BodyId ground = world.create_body({.type = BodyType::Static});
  const JointId joint = world.create_joint(ground, add_door(world, 9.5, 8),
                                           {.kind = RevoluteDefinition{.limits = Range{-50, 50}}});
  for (int i = 0; i < 120; ++i) {
    BasicWorld<TypeParam> other;
    if (i % 40 == 0) {
      restore(other, save(world));
      EXPECT_EQ(other.read(joint).angle, world.read(joint).angle);
      other.step();
    }
    world.step();
    if (i % 40 == 0) {
      EXPECT_EQ(other.read(joint).angle, world.read(joint).angle);
    }
  }
  EXPECT_NEAR(world.read(joint).angle, 9.5 - 4 * kPi + 16, 1e-3);
}

// Wheels whose ratio is no integer mesh at the angles that they have, through teleports too.
TYPED_TEST(JointAngles, OfGearsCountTheTurnsThatBodiesHaveCome) {
  for (const double angle : {0.0, 7.0, -20.0}) {
    BasicWorld<TypeParam> world(weightless());
    const BodyId ground = world.create_body({.type = BodyType::Static});
    const auto wheel = [&](double at, double turned, double spin) {
      const BodyId body = world.create_body(
          {.position = {at, 0}, .angle = turned, .angular_velocity = spin, .may_sleep = false},
          {.geometry = Circle{0.5}});
      world.create_joint(ground, body, {.kind = RevoluteDefinition{.anchor_a = {at, 0}}});
      return body;
    };
    const BodyId a = wheel(0, angle, 4), b = wheel(2, 0.3 - 2.5 * angle, -10);
    world.create_joint(a, b, {.kind = GearDefinition{.ratio = -2.5, .phase = 0.3}});
    for (int i = 0; i < 240; ++i) {
      world.step();
      if (i % 50 == 49) world.set_position(a, world.position(a), world.angle(a));
      ASSERT_NEAR(world.angle(b), 0.3 - 2.5 * world.angle(a), 2e-3) << angle << " " << i;
    }
    EXPECT_NEAR(world.angle(a), angle + 16, 0.05);
  }
}

// A joint wound past half a turn comes back the way that it went.
TYPED_TEST(JointAngles, OfSpringsPassHalfATurn) {
  BasicWorld<TypeParam> world(weightless());
  const BodyId ground = world.create_body({.type = BodyType::Static}), door = add_door(world, 0);
  const JointId joint =
      world.create_joint(ground, door, {.kind = WeldDefinition{.angular_spring = Spring{1, 0.5}}});
  const double stiffness = world.inertia(door) * 4 * kPi * kPi;
  for (int i = 0; i < 600; ++i) {
    world.apply_torque(door, 4 * stiffness);
    world.step();
  }
  EXPECT_NEAR(world.read(joint).angle, 4, 1e-3);
  run(world, 600);
  EXPECT_NEAR(world.angle(door), 0, 1e-3);
}

// Two scenes of a door at 3.2 rad whose hinge is made for that, in the world and in Precise.
TEST(JointAnglesOfScenes, AreBornAtTheNearestTurnInEveryDriver) {
  for (const double angle : {3.2, -3.2, 9.5, 40.0}) {
    for (const bool spring : {false, true}) {
      Scene scene;
      scene.gravity = {0, 0};
      scene.bodies.push_back({.name = "door", .angle = angle, .mass = 1, .inertia = 0.8});
      RevoluteJoint hinge{.name = "hinge", .body_a = "world", .body_b = "door", .reference_angle = angle};
      if (spring) {
        hinge.spring = Spring{2, 0.7};
      } else {
        hinge.limits = Range{-0.1, 0.1};
      }
      scene.joints.push_back(hinge);
      DoubleWorld world(world_definition(scene));
      const SceneParts parts = add_scene(world, scene);
      for (int i = 0; i < 120; ++i) world.step();
      EXPECT_NEAR(world.angle(parts.bodies[0]), angle, 1e-9);
      Simulation precise = compile(scene, Precise{.tolerance = 1e-9});
      precise.step(120);
      EXPECT_NEAR(precise.state(0).angle, angle, 1e-9);
    }
  }
}

}  // namespace
}  // namespace plumb
