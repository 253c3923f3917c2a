#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/world/support.h"

// Joints with a limit of their force: a force at its limit keeps its direction.
namespace plumb {
namespace {

template <class Real>
class ForceLimits : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(ForceLimits, Reals);

constexpr double kForce = 5, kMass = 2;  // N, kg

struct Puck {
  BodyId base{}, body{};
};

// A box of kMass without gravity, beside a static body.
template <class Real>
Puck add_puck(BasicWorld<Real>& world, Vec2d velocity = {}) {
  return {
      world.create_body({.type = BodyType::Static}),
      world.create_body({.velocity = velocity}, ShapeDefinition{.geometry = Box{1, 1}, .density = kMass})};
}

Vec2d direction_of(int degrees) {
  const double angle = degrees * std::numbers::pi / 180;
  return {std::cos(angle), std::sin(angle)};
}

// Expects the speed F t / m in the direction `along` after half a second.
template <class Real>
void expect_pulled(BasicWorld<Real>& world, BodyId body, Vec2d along) {
  for (int i = 0; i < 30; ++i) world.step();
  const Vec2d velocity = world.velocity(body), right = (kForce * 0.5 / kMass) * along;
  EXPECT_NEAR(velocity.x, right.x, 1e-4);
  EXPECT_NEAR(velocity.y, right.y, 1e-4);
}

// Expects a joint between a static body and a puck, of the kind that `towards` makes for a direction, to pull
// it there in all directions.
template <class Real, class Kind>
void expect_pulled_towards_all(const Kind& towards) {
  for (int degrees = 0; degrees < 360; degrees += 15) {
    SCOPED_TRACE(degrees);
    BasicWorld<Real> world({.gravity = {0, 0}});
    const Puck puck = add_puck(world);
    const Vec2d along = direction_of(degrees);
    world.create_joint(puck.base, puck.body, {.kind = towards(along)});
    expect_pulled(world, puck.body, along);
  }
}

TYPED_TEST(ForceLimits, OfMouseJointsPullTowardsTheTarget) {
  expect_pulled_towards_all<TypeParam>(
      [](Vec2d along) { return MouseDefinition{.target = 1e4 * along, .max_force = kForce}; });
}

TYPED_TEST(ForceLimits, OfMotorJointsPullTowardsTheTarget) {
  expect_pulled_towards_all<TypeParam>([](Vec2d along) {
    return MotorDefinition{.target_position = 1e4 * along, .max_force = kForce, .max_torque = 100};
  });
}

// A puck on a table seen from above slides straight on for v^2 m / (2 F).
TYPED_TEST(ForceLimits, OfFrictionJointsBrakeAgainstTheMotion) {
  for (int degrees = 0; degrees < 360; degrees += 15) {
    SCOPED_TRACE(degrees);
    BasicWorld<TypeParam> world({.gravity = {0, 0}});
    const Vec2d along = direction_of(degrees);
    const double speed = 3, distance = speed * speed * kMass / (2 * kForce);
    const Puck puck = add_puck(world, speed * along);
    world.create_joint(puck.base, puck.body,
                       {.kind = FrictionDefinition{.max_force = kForce, .max_torque = 100}});
    for (int i = 0; i < 120; ++i) world.step();
    const Vec2d stopped = world.position(puck.body);
    // Half of a step's braking, F dt^2 / (2 m), and the last, partial step.
    EXPECT_NEAR(dot(stopped, along), distance, 0.01);
    EXPECT_NEAR(cross(along, stopped), 0, 1e-4);
  }
}

}  // namespace
}  // namespace plumb
