#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/world/solver_scenes.h"

// Each of the eleven kinds of joint with each solver, against what mechanics says of it. h = 1/240 s.
namespace plumb {
namespace {

using test::add_hook;
using test::add_mass;
using test::with;

constexpr double kH = 1.0 / 240;
// Fall of a body in a substep before a joint answers, m.
constexpr double kFall = kGravity * kH * kH;

class SolverJoints : public testing::TestWithParam<Solver> {};
INSTANTIATE_TEST_SUITE_P(, SolverJoints, test::all_solvers(), test::solver_name);

// The rod leaves its circle along the tangent; Baumgarte's feedback of 0.2 leaves five times that.
TEST_P(SolverJoints, DistanceKeepsItsLength) {
  DoubleWorld world(with(GetParam()));
  const BodyId mass = add_mass(world, {1, 0}, 2, 1);
  const JointId rod = world.create_joint(add_hook(world), mass, {.kind = DistanceDefinition{.length = 1}});
  const double worst = test::run_gap(world, {rod}, 240);
  EXPECT_LT(worst, 5 * test::tangent_drift(std::sqrt(2 * kGravity), 1, kH));
}

// Bodies may cease to be dynamic while joints hold them: those between two that do not give way do nothing.
TEST_P(SolverJoints, BetweenBodiesThatNoLongerGiveWayHoldNothing) {
  for (const BodyType type : {BodyType::Static, BodyType::Kinematic}) {
    DoubleWorld world(with(GetParam())), alone(with(GetParam()));
    const BodyId arm = add_mass(world, {1, 0}, 2, 1), hook = add_hook(world);
    const JointId hinge = world.create_joint(
        hook, arm, {.kind = RevoluteDefinition{.anchor_a = {0.5, 0}, .anchor_b = {-0.5, 0}}});
    world.create_joint(hook, arm, {.kind = WeldDefinition{.anchor_a = {1, 0}}});
    const test::Chain chain = test::add_chain(world, 3), same = test::add_chain(alone, 3);
    world.step(kH, 1);
    alone.step(kH, 1);
    const Vec2d place = world.position(arm);
    world.set_type(arm, type);
    world.set_velocity(arm, {});
    run(world, 60, kH, 1);
    run(alone, 60, kH, 1);
    EXPECT_EQ(world.position(arm), place);
    EXPECT_EQ(world.position(chain.links[2]), alone.position(same.links[2]));
    world.set_type(arm, BodyType::Dynamic);
    EXPECT_LT(test::run_gap(world, {hinge}, 240), test::tangent_drift(std::sqrt(2 * kGravity), 1, kH));
  }
}

TEST_P(SolverJoints, RopesAreSlackUntilTheyAreTaut) {
  DoubleWorld world(with(GetParam()));
  const BodyId mass = add_mass(world, {0, -0.5}, 2, 1);
  const JointId rope =
      world.create_joint(add_hook(world), mass, {.kind = DistanceDefinition{.range = Range{0, 1}}});
  run(world, 12);
  EXPECT_NEAR(world.velocity(mass).y, -kGravity * 0.2, 1e-12);
  EXPECT_EQ(world.read(rope).force, 0);
  run(world, 120);
  // Soft rows yield to a load, by less than it falls in a substep.
  EXPECT_NEAR(world.read(rope).length, 1, kFall);
  EXPECT_NEAR(world.read(rope).force, 2 * kGravity, 1e-6);
}

TEST_P(SolverJoints, RevoluteMotorsPullWithTheirTorque) {
  DoubleWorld world(test::weightless(GetParam()));
  const BodyId wheel = add_mass(world, {0, 0}, 1, 0.5);
  const JointId joint =
      world.create_joint(add_hook(world), wheel, {.kind = RevoluteDefinition{.motor = Motor{3, 2}}});
  run(world, 30);
  EXPECT_NEAR(world.angular_velocity(wheel), 2 * 0.5 / 0.5, 1e-12);  // torque time / inertia
  EXPECT_NEAR(world.read(joint).torque, 2, 1e-12);
  run(world, 60);
  EXPECT_NEAR(world.angular_velocity(wheel), 3, 1e-12);
}

TEST_P(SolverJoints, RevoluteLimitsHold) {
  DoubleWorld world(with(GetParam()));
  const BodyId rod = add_mass(world, {0.5, 0}, 1, 1.0 / 12);
  const JointId joint = world.create_joint(
      add_hook(world), rod, {.kind = RevoluteDefinition{.anchor_b = {-0.5, 0}, .limits = Range{-0.5, 1}}});
  double lowest = 0;
  for (int i = 0; i < 240; ++i) {
    world.step();
    lowest = std::min(lowest, world.read(joint).angle);
  }
  // It arrives with w^2 = 3 g sin(0.5) / L, and is held at latest a substep later.
  EXPECT_GT(lowest, -0.5 - kH * std::sqrt(3 * kGravity * std::sin(0.5)));
  // In a substep the rod falls by 3 g / (2 L) h^2. A sweep sees the inertia about the centre, a quarter of
  // that about the hinge, and takes back a quarter.
  EXPECT_NEAR(world.read(joint).angle, -0.5, 4 * 1.5 * kFall);
  EXPECT_LT(world.read(joint).linear_error, 2 * kFall);
}

/// Returns the lead of a solver's positions, s. Semi-implicit Euler moves bodies by the velocity at the
/// substep's end, half a substep ahead. Where islands are solved as one, bodies move by the mean of both
/// ends' velocities, which is exact here.
double ahead(Solver solver) { return solver == Solver::Direct || solver == Solver::SoftSteps ? 0 : kH; }

TEST_P(SolverJoints, PrismaticSlidesDownToItsLimit) {
  DoubleWorld world(with(GetParam()));
  const BodyId slider = add_mass(world, {0, 0}, 2, 1);
  const JointId joint = world.create_joint(
      add_hook(world), slider, {.kind = PrismaticDefinition{.axis = {1, -1}, .limits = Range{-1, 1}}});
  const double t = 0.5, a = kGravity * std::sqrt(0.5);
  run(world, 30);
  EXPECT_NEAR(world.read(joint).translation, a * t * t / 2 + a * ahead(GetParam()) * t / 2, 1e-9);
  run(world, 240);
  EXPECT_NEAR(world.read(joint).translation, 1, 1e-4);
  EXPECT_LT(world.read(joint).linear_error, kFall);
  EXPECT_LT(world.read(joint).angular_error, 1e-9);
}

TEST_P(SolverJoints, WeldsBearAWeightAtAnArm) {
  DoubleWorld world(with(GetParam()));
  const BodyId beam = add_mass(world, {1, 0}, 2, 0.5);
  const JointId joint =
      world.create_joint(add_hook(world), beam, {.kind = WeldDefinition{.anchor_b = {-1, 0}}});
  run(world, 240);
  EXPECT_LT(world.read(joint).linear_error, kFall);
  EXPECT_LT(world.read(joint).angular_error, kFall);
  EXPECT_NEAR(world.read(joint).force, 2 * kGravity, 1e-6);
  EXPECT_NEAR(world.read(joint).torque, 2 * kGravity, 1e-6);
}

// k = m (2 pi f)^2: the sag m g / k does not depend on the mass.
TEST_P(SolverJoints, WheelsSagByTheirSpring) {
  DoubleWorld world(with(GetParam()));
  const BodyId wheel = add_mass(world, {0, 0}, 3, 1);
  const JointId joint =
      world.create_joint(add_hook(world), wheel, {.kind = WheelDefinition{.spring = Spring{2, 0.7}}});
  run(world, 600);
  const double sag = kGravity / std::pow(2 * test::kPi * 2, 2);
  EXPECT_NEAR(world.read(joint).translation, -sag, 1e-9);
  EXPECT_LT(world.read(joint).linear_error, 1e-9);
}

TEST_P(SolverJoints, WheelsKeepToTheirAxis) {
  DoubleWorld world(with(GetParam()));
  const BodyId wheel = add_mass(world, {0, 0}, 3, 1);
  const JointId joint =
      world.create_joint(add_hook(world), wheel, {.kind = WheelDefinition{.spring = Spring{2, 0.7}}});
  for (int i = 0; i < 600; ++i) {
    world.apply_force(wheel, {30, 0});
    world.step();
  }
  // Soft steps hold it by a spring of a quarter of the substep's rate, 60 Hz.
  const double soft = 30 / (3 * std::pow(2 * test::kPi * 60, 2));
  EXPECT_NEAR(world.position(wheel).x, 0, GetParam() == Solver::SoftSteps ? 1.001 * soft : 1e-9);
  EXPECT_NEAR(world.read(joint).force, std::hypot(30, 3 * kGravity), 1e-6);
}

TEST_P(SolverJoints, MotorJointsReachTheirTarget) {
  DoubleWorld world(test::weightless(GetParam()));
  const BodyId body = add_mass(world, {0, 0}, 3, 1);
  world.create_joint(
      add_hook(world), body,
      {.kind = MotorDefinition{
           .target_position = {1, 2}, .target_angle = 0.5, .max_force = 100, .max_torque = 100}});
  run(world, 300);
  // exp(-w t) (1 + w t) of 2.2 m, w = 2 pi 2 Hz, t = 5 s.
  EXPECT_NEAR(world.position(body).x, 1, 1e-9);
  EXPECT_NEAR(world.position(body).y, 2, 1e-9);
  EXPECT_NEAR(world.angle(body), 0.5, 1e-9);
}

TEST_P(SolverJoints, MousePullsAsASpringAndNoHarderThanItMay) {
  for (const double strongest : {100.0, 10.0}) {
    DoubleWorld world(with(GetParam()));
    const BodyId body = add_mass(world, {0, 0}, 2, 1);
    world.create_joint(add_hook(world), body,
                       {.kind = MouseDefinition{.spring = Spring{3, 1}, .max_force = strongest}});
    run(world, 300);
    const double t = 5, a = kGravity - strongest / 2;
    if (a < 0) {
      EXPECT_NEAR(world.position(body).y, -kGravity / std::pow(2 * test::kPi * 3, 2), 1e-9);
    } else {
      // Until the spring is taut it pulls less: for no longer than a fall of F / k takes.
      const double taut = std::sqrt(2 * strongest / (2 * std::pow(2 * test::kPi * 3, 2)) / a);
      EXPECT_NEAR(world.velocity(body).y, -a * t, (kGravity - a) * taut);
    }
  }
}

TEST_P(SolverJoints, GearsTurnInTheirRatio) {
  DoubleWorld world(test::weightless(GetParam()));
  const BodyId a = add_mass(world, {0, 0}, 1, 0.5), b = add_mass(world, {2, 0}, 1, 0.2);
  world.create_joint(add_hook(world), a, {.kind = RevoluteDefinition{}});
  world.create_joint(add_hook(world, {2, 0}), b, {.kind = RevoluteDefinition{}});
  const JointId gear = world.create_joint(a, b, {.kind = GearDefinition{.ratio = -2}});
  for (int i = 0; i < 120; ++i) {
    world.apply_torque(a, 1);
    world.step();
  }
  // The inertia that a feels is 0.5 + 2^2 0.2.
  EXPECT_NEAR(world.angular_velocity(a), 2 / 1.3, 1e-6);
  EXPECT_NEAR(world.angular_velocity(b), -4 / 1.3, 1e-6);
  EXPECT_LT(world.read(gear).angular_error, 1e-4);
}

TEST_P(SolverJoints, PulleysAreAtwoodMachines) {
  DoubleWorld world(with(GetParam()));
  const BodyId a = add_mass(world, {-1, 0}, 1, 1), b = add_mass(world, {1, 0}, 3, 1);
  const JointId rope =
      world.create_joint(a, b, {.kind = PulleyDefinition{.ground_a = {-1, 5}, .ground_b = {1, 5}}});
  run(world, 60);
  EXPECT_NEAR(world.velocity(b).y, -kGravity / 2, 1e-9);
  EXPECT_NEAR(world.read(rope).length, 10, kFall);
  EXPECT_NEAR(world.read(rope).force, 1.5 * kGravity, 1e-9);
}

TEST_P(SolverJoints, RatchetsGoOneWay) {
  DoubleWorld world(test::weightless(GetParam()));
  const BodyId wheel = add_mass(world, {0, 0}, 1, 1);
  const BodyId hook = add_hook(world);
  world.create_joint(hook, wheel, {.kind = RevoluteDefinition{}});
  world.create_joint(hook, wheel, {.kind = RatchetDefinition{.tooth = 0.25}});
  const auto turn = [&](double torque, int steps) {
    for (int i = 0; i < steps; ++i) {
      world.apply_torque(wheel, torque);
      world.step();
    }
  };
  turn(1, 60);
  // At the tooth at 0.5, or past it.
  EXPECT_NEAR(world.angle(wheel), 0.5 + ahead(GetParam()) / 2, 1e-9);
  world.set_angular_velocity(wheel, 0);
  turn(-1, 120);
  EXPECT_NEAR(world.angle(wheel), 0.5, 1e-4);
  EXPECT_NEAR(world.angular_velocity(wheel), 0, 1e-4);
}

TEST_P(SolverJoints, FrictionJointsSlowDown) {
  DoubleWorld world(test::weightless(GetParam()));
  const BodyId puck = add_mass(world, {0, 0}, 2, 0.5, {3, 0});
  world.set_angular_velocity(puck, 4);
  world.create_joint(add_hook(world), puck, {.kind = FrictionDefinition{.max_force = 3, .max_torque = 1}});
  run(world, 60);
  EXPECT_NEAR(world.velocity(puck).x, 3 - 1.5, 1e-6);
  EXPECT_NEAR(world.angular_velocity(puck), 4 - 2, 1e-6);
  run(world, 120);
  EXPECT_NEAR(world.velocity(puck).x, 0, 1e-9);
  EXPECT_NEAR(world.angular_velocity(puck), 0, 1e-9);
}

}  // namespace
}  // namespace plumb
