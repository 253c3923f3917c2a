#include <gtest/gtest.h>

#include <cmath>

#include "tests/world/support.h"

namespace plumb {
namespace {

template <class Real>
class Motion : public testing::Test {};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(Motion, Precisions);

// Rounding of a velocity that grows to v in n additions: each adds half a unit in the last place at most, and
// the errors are mostly the same from one addition to the next.
template <class Real>
double rounding(double size, int additions) {
  return 0.5 * static_cast<double>(std::numeric_limits<Real>::epsilon()) * size * additions;
}

TYPED_TEST(Motion, FreeFlightUnderGravityIsTheParabola) {
  BasicWorld<TypeParam> world;
  const BodyId body = add_body(world, {3, 100}, {}, {2, 5});
  run(world, 120);
  const double t = 2, v = 5 - kGravity * t;
  const int additions = 480;
  EXPECT_NEAR(world.velocity(body).y, v, rounding<TypeParam>(16, additions));
  EXPECT_NEAR(world.position(body).y, 100 + 5 * t - kGravity * t * t / 2,
              rounding<TypeParam>(16, additions) * t / 2);
  EXPECT_NEAR(world.position(body).x, 7, rounding<TypeParam>(2, additions));
}

TYPED_TEST(Motion, FarFromTheOriginNothingIsLost) {
  BasicWorld<TypeParam> here, there;
  const Vec2d far{1e7, -1e7};
  const BodyId near_body = add_body(here, {0, 0}, {}, {1, 2}), far_body = add_body(there, far, {}, {1, 2});
  run(here, 600), run(there, 600);
  const Vec2d apart = (there.position(far_body) - far) - here.position(near_body);
  // Positions are doubles: 600 additions at 1e7 m.
  EXPECT_NEAR(apart.x, 0, 600 * 1e7 * 1.2e-16);
  EXPECT_NEAR(apart.y, 0, 600 * 1e7 * 1.2e-16);
}

TYPED_TEST(Motion, ForceActsThroughOneStep) {
  BasicWorld<TypeParam> world(weightless());
  const BodyId body = add_body(world, {}, {.geometry = Box{2, 1}, .density = 3});  // 6 kg
  world.apply_force(body, {12, 0}, {0, 0.5});
  run(world, 2);
  const double dt = 1.0 / 60, inertia = 6 * (4 + 1) / 12.0;
  EXPECT_NEAR(world.velocity(body).x, 2 * dt, 1e-7);
  EXPECT_NEAR(world.angular_velocity(body), -12 * 0.5 / inertia * dt, 1e-7);
}

TYPED_TEST(Motion, ImpulseAtACornerTurns) {
  BasicWorld<TypeParam> world(weightless());
  const BodyId body = add_body(world, {1, 1}, {.geometry = Box{1, 1}, .density = 2});
  world.apply_impulse(body, {0, 3}, {1.5, 1.5});
  EXPECT_NEAR(world.velocity(body).y, 1.5, 1e-6);
  EXPECT_NEAR(world.angular_velocity(body), 3 * 0.5 / (2 * 2 / 12.0), 1e-5);
  EXPECT_NEAR(world.velocity_at(body, {1.5, 1}).y, 1.5 + 4.5 * 0.5, 1e-5);
}

// v' = g - c v: v = u + (v0 - u) e^(-c t) with u = g / c, and x = x0 + u t + (v0 - u) (1 - e^(-c t)) / c.
TYPED_TEST(Motion, ADampedFallIsExactAtAnyDamping) {
  for (const double c : {1e-6, 0.05, 1.0, 7.5, 60.0}) {
    BasicWorld<TypeParam> world;
    const BodyId body = world.create_body({.position = {0, 50},
                                           .velocity = {3, 0},
                                           .angular_velocity = 4,
                                           .mass = MassProperties{2, {}, 1},
                                           .linear_damping = c,
                                           .angular_damping = c});
    run(world, 120);
    const double t = 2, u = -kGravity / c, left = std::exp(-c * t), gone = -std::expm1(-c * t);
    const double tolerance = rounding<TypeParam>(20, 480);
    EXPECT_NEAR(world.velocity(body).y, u * gone, tolerance) << c;
    EXPECT_NEAR(world.velocity(body).x, 3 * left, tolerance) << c;
    // Written so that nothing cancels for a small c.
    const double fallen =
        kGravity * (c < 1e-3 ? t * t * (0.5 - c * t / 6 + c * c * t * t / 24) : (t - gone / c) / c);
    EXPECT_NEAR(world.position(body).y, 50 - fallen, tolerance * t) << c;
    EXPECT_NEAR(world.position(body).x, 3 * gone / c, tolerance * t) << c;
    EXPECT_NEAR(world.angular_velocity(body), 4 * left, tolerance) << c;
    EXPECT_NEAR(world.angle(body), 4 * gone / c, tolerance * t) << c;
  }
}

TYPED_TEST(Motion, DampingIsExponential) {
  BasicWorld<TypeParam> world(weightless());
  BodyDefinition definition;
  definition.velocity = {10, 0};
  definition.angular_velocity = 4;
  definition.linear_damping = 0.7;
  definition.angular_damping = 3;
  const BodyId body = world.create_body(definition, ShapeDefinition{});
  run(world, 90);
  EXPECT_NEAR(world.velocity(body).x, 10 * std::exp(-0.7 * 1.5), rounding<TypeParam>(10, 360));
  EXPECT_NEAR(world.angular_velocity(body), 4 * std::exp(-3 * 1.5), rounding<TypeParam>(4, 360));
}

// A body on a rail, two welded ones, one on a frictionless slope, a rotor under a torque and a link that
// falls by its hinge's side all have the force / damping of a free body as terminal speed.
TYPED_TEST(Motion, TheTerminalSpeedOfDampedBodiesWithJointsAndContactsIsTheFreeOne) {
  constexpr double kSlope = 0.5;  // rad
  for (const Solver solver :
       {Solver::SoftSteps, Solver::SequentialImpulses, Solver::Jakobsen, Solver::Xpbd, Solver::Direct}) {
    for (const double c : {2.0, 10.0, 100.0}) {
      WorldDefinition settings = without_sleep();
      settings.solver = solver;
      BasicWorld<TypeParam> world(settings);
      const Vec2d along{std::cos(kSlope), std::sin(kSlope)}, up{-along.y, along.x};
      const Material smooth{.friction = 0};
      const BodyId fixed = world.create_body({.type = BodyType::Static});
      world.create_shape(fixed, {.geometry = Box{400, 1},
                                 .position = Vec2d{0, 500} - 0.5 * up,
                                 .angle = kSlope,
                                 .material = smooth});
      const auto body = [&](Vec2d at, double angle = 0) {
        return world.create_body({.position = at, .angle = angle, .linear_damping = c, .angular_damping = c},
                                 ShapeDefinition{.geometry = Box{1, 1}, .material = smooth});
      };
      const BodyId bead = body({0, 0}), left = body({4, 0}), right = body({6, 0}), rotor = body({10, 0}),
                   slider = body(Vec2d{0, 500} + 0.5 * up, kSlope);
      world.create_joint(fixed, bead, {.kind = PrismaticDefinition{.axis = {0, 1}}});
      world.create_joint(left, right, {.kind = WeldDefinition{.anchor_a = {2, 0}}});
      world.create_joint(fixed, rotor,
                         {.kind = RevoluteDefinition{.anchor_a = {10, 0}, .motor = Motor{0, 0}}});
      for (int i = 0; i < 60 + static_cast<int>(600 / c); ++i) {
        world.apply_torque(rotor, 3 * world.inertia(rotor));
        world.step(1.0 / 60, 4);
      }
      // Rounding in float: half a unit in the last place per substep, of which 1 / (c h) add up.
      const double tolerance = 5e-5;
      EXPECT_NEAR(world.velocity(bead).y * c / kGravity, -1, tolerance) << c << int(solver);
      EXPECT_NEAR(world.velocity(left).y * c / kGravity, -1, tolerance) << c << int(solver);
      EXPECT_NEAR(world.angular_velocity(rotor) * c / 3, 1, tolerance) << c << int(solver);
      EXPECT_NEAR(dot(world.velocity(slider), along) * c / (kGravity * std::sin(kSlope)), -1, tolerance)
          << c << int(solver);
    }
  }
}

// A damped pendulum's hinge hides no damping: the tree takes substeps in parts when it turns fast.
TYPED_TEST(Motion, AHingedRotorThatTurnsFastReachesTorqueOverDamping) {
  for (const double c : {10.0, 100.0}) {
    BasicWorld<TypeParam> world(weightless());
    const BodyId fixed = world.create_body({.type = BodyType::Static});
    const BodyId rotor = world.create_body({.angular_damping = c}, ShapeDefinition{.geometry = Box{1, 1}});
    world.create_joint(fixed, rotor, {.kind = RevoluteDefinition{}});
    for (int i = 0; i < 120; ++i) {
      world.apply_torque(rotor, 90 * c * world.inertia(rotor));
      world.step(1.0 / 60, 4);
    }
    EXPECT_NEAR(world.angular_velocity(rotor), 90, 90 * 1e-4) << c;
  }
}

TYPED_TEST(Motion, GravityScaleAndLocks) {
  BasicWorld<TypeParam> world;
  BodyDefinition definition;
  definition.gravity_scale = -0.5;
  const BodyId balloon = world.create_body(definition, ShapeDefinition{});
  definition = {};
  definition.position = {10, 0};
  definition.velocity = {1, 1};
  definition.angular_velocity = 1;
  definition.lock_y = definition.lock_rotation = true;
  const BodyId bead = world.create_body(definition, ShapeDefinition{});
  run(world, 60);
  EXPECT_NEAR(world.velocity(balloon).y, kGravity / 2, 1e-4);
  EXPECT_NEAR(world.position(bead).x, 11, 1e-5);
  EXPECT_EQ(world.position(bead).y, 0);
  world.set_locks(bead, true, false, false);
  run(world, 60);
  EXPECT_NEAR(world.position(bead).x, 11, 1e-5);
  EXPECT_LT(world.position(bead).y, -4);
}

TYPED_TEST(Motion, ALockedRotationStaysWhateverSpinItIsGiven) {
  BasicWorld<TypeParam> world;
  const BodyId body = world.create_body({.angular_velocity = 3, .lock_rotation = true}, ShapeDefinition{});
  run(world, 10);
  EXPECT_EQ(world.angle(body), 0);
  world.set_angular_velocity(body, 5);
  EXPECT_EQ(world.angular_velocity(body), 0);
  run(world, 10);
  EXPECT_EQ(world.angle(body), 0);
}

// A shape that was just added waits for the next step to count: until then velocities are told of the new
// centre of mass, at the body's present angle.
TYPED_TEST(Motion, AJumpKeepsTheVelocityOfABodyWhoseMassHasJustChanged) {
  BasicWorld<TypeParam> world;
  const BodyId body = world.create_body({.velocity = {1, 2}, .angular_velocity = 3}, ShapeDefinition{});
  world.create_shape(body, {.geometry = Circle{0.4}, .position = {0.8, 0.1}});
  const Vec2d before = world.velocity(body);
  EXPECT_NE(before, (Vec2d{1, 2}));
  world.set_position(body, {5, 5}, 1.3);
  EXPECT_EQ(world.velocity(body), before);
}

TYPED_TEST(Motion, KinematicBodiesMoveAsToldAndPush) {
  BasicWorld<TypeParam> world(weightless());
  BodyDefinition definition;
  definition.type = BodyType::Kinematic;
  const BodyId pusher = world.create_body(definition, ShapeDefinition{.geometry = Box{1, 1}});
  const BodyId box = add_box(world, {1.2, 0});
  world.set_velocity(pusher, {1, 0});
  run(world, 60);
  EXPECT_NEAR(world.position(pusher).x, 1, 1e-6);
  EXPECT_NEAR(world.velocity(box).x, 1, 1e-4);
  EXPECT_GE(world.position(box).x, 2 - 1e-3);
  world.move_towards(pusher, {1, 3}, 0.5, 1.0 / 60);
  world.step();
  EXPECT_NEAR(world.position(pusher).y, 3, 1e-5);
  EXPECT_NEAR(world.angle(pusher), 0.5, 1e-6);
}

// Neither gravity nor forces reach what is not dynamic, in free flight or among contacts.
TYPED_TEST(Motion, OnlyDynamicBodiesFall) {
  BasicWorld<TypeParam> world;
  const BodyId still = world.create_body({.type = BodyType::Static}, {.geometry = Box{4, 1}});
  const BodyId told = world.create_body({.type = BodyType::Kinematic, .position = {9, 0}, .velocity = {1, 0}},
                                        {.geometry = Box{4, 1}});
  const BodyId box = add_box(world, {9, 1}), falling = add_box(world, {30, 0});
  for (int i = 0; i < 60; ++i) {
    for (const BodyId each : {still, told}) world.apply_force(each, {0, -100}), world.apply_torque(each, 5);
    world.step();
  }
  EXPECT_EQ(world.position(still), Vec2d{});
  EXPECT_NEAR(world.position(told).x, 10, 1e-5);
  EXPECT_EQ(world.position(told).y, 0);
  EXPECT_EQ(world.angle(told), 0);
  EXPECT_NEAR(world.position(box).y, 1, 1e-3);
  EXPECT_NEAR(world.position(falling).y, -kGravity / 2, 1e-4);
}

TYPED_TEST(Motion, SpinKeepsItsRateAndCountsTurns) {
  BasicWorld<TypeParam> world(weightless());
  BodyDefinition definition;
  definition.angular_velocity = 100;
  const BodyId body = world.create_body(definition, ShapeDefinition{.geometry = Box{1, 1}});
  run(world, 600);
  EXPECT_EQ(world.angular_velocity(body), 100);
  // h w is rounded the same way each time; the sum of 600 doubles is rounded as well.
  EXPECT_NEAR(world.angle(body), 1000, 2 * rounding<TypeParam>(1000, 2) + rounding<double>(1000, 600));
}

TYPED_TEST(Motion, TypeCanChange) {
  BasicWorld<TypeParam> world;
  add_ground(world);
  const BodyId body = add_box(world, {0, 3});
  world.set_type(body, BodyType::Static);
  run(world, 30);
  EXPECT_EQ(world.position(body).y, 3);
  EXPECT_EQ(world.mass(body), 0);
  world.set_type(body, BodyType::Dynamic);
  EXPECT_NEAR(world.mass(body), 1, 1e-6);
  run(world, 120);
  EXPECT_NEAR(world.position(body).y, 0.5, 1e-3);
}

}  // namespace
}  // namespace plumb
