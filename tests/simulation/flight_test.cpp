#include <gtest/gtest.h>

#include <cmath>

#include "tests/simulation/scenes.h"

namespace plumb {
namespace {

using namespace plumb::testing;

const Vec2d kStart{-3, 100}, kVelocity{4, 7};

Simulation thrown(const Realtime& accuracy) {
  Body body = disc("a", kStart);
  body.velocity = kVelocity;
  return compile(with(empty_scene(), {body}), accuracy);
}

/// Returns the body's place after `t`, if gravity's displacement is off by `excess` g t^2 / 2.
Vec2d parabola(double t, double excess = 0) {
  return {kStart.x + kVelocity.x * t, kStart.y + kVelocity.y * t - (1 + excess) * kGravity * t * t / 2};
}

// 600 steps of 4 additions of positions of about 500 m: rounding 2^-53 * 500 * sqrt(2400) = 3e-12.
TEST(Flight, VerletIsExactUnderConstantForce) {
  Simulation world = thrown({});
  for (int i = 0; i < 600; ++i) {
    world.step();
    const BodyState state = world.state(0);
    EXPECT_NEAR(state.position.x, parabola(world.time()).x, 1e-12);
    EXPECT_NEAR(state.position.y, parabola(world.time()).y, 5e-12);
    EXPECT_NEAR(state.velocity.y, kVelocity.y - kGravity * world.time(), 2e-12);
  }
}

TEST(Flight, FloatIsExactToItsRounding) {
  Simulation world = thrown({.precision = Precision::Float});
  world.step(60);
  EXPECT_NEAR(world.state(0).position.y, parabola(1).y, 240 * 100 * 0x1p-25);
}

// The textbook's discrete values: y_n = y_0 + v_0 t - g t (t +- h) / 2.
TEST(Flight, EulerSteppersGiveTheirDiscreteValues) {
  for (const int substeps : {1, 4}) {
    for (const int sign : {1, -1}) {
      Realtime accuracy =
          with_integrator(sign > 0 ? Integrator::SemiImplicitEuler : Integrator::ExplicitEuler);
      accuracy.substeps = substeps;
      const double h = accuracy.dt / substeps;
      Simulation world = thrown(accuracy);
      for (int i = 0; i < 120; ++i) {
        world.step();
        const double t = world.time();
        EXPECT_NEAR(world.state(0).position.y, parabola(t).y - sign * kGravity * h * t / 2, 1e-12);
      }
    }
  }
}

TEST(Flight, TimeDoesNotAccumulateRounding) {
  Simulation world = thrown({.dt = 0.1});
  world.step(1000);
  EXPECT_EQ(world.time(), 1000 * 0.1);
}

// Linear drag: v = v_inf + (v_0 - v_inf) exp(-t c/m). Order of convergence from two substeps.
TEST(Flight, DragConvergesWithSecondOrder) {
  const double c = 0.8;
  const auto error_at = [&](int substeps) {
    Body body = disc("a", kStart);
    body.velocity = kVelocity;
    Scene scene = with(empty_scene(), {body});
    scene.forces = {LinearDrag{"a", c}};
    Simulation world = compile(scene, Realtime{.substeps = substeps});
    double worst = 0;
    for (int i = 0; i < 120; ++i) {
      world.step();
      const double t = world.time(), end = -kGravity / c;
      const double exact = kStart.y + end * t + (kVelocity.y - end) * (1 - std::exp(-c * t)) / c;
      worst = std::fmax(worst, std::abs(world.state(0).position.y - exact));
    }
    return worst;
  };
  const double coarse = error_at(1), fine = error_at(4);
  EXPECT_NEAR(std::log2(coarse / fine) / 2, 2, 0.05);
  EXPECT_LT(fine, 5e-5);
}

// Over a step of z = c dt / m the velocity decays by 1 / (1 + z + z^2 / 2): strong drag stops a body, and
// under its weight it falls at m g / c, or sqrt(m g / k), from then on.
TEST(Flight, StrongDragStopsABodyAndNeverReversesIt) {
  constexpr double kLeast = 1e-300;  // rounding of numbers that have no full precision any more
  for (const double z : {0.1, 1.0, 2.5, 10.0, 1e3, 1e6}) {
    for (const bool falls : {false, true}) {
      for (const bool quadratic : {false, true}) {
        Body body = disc("a", {0, 0});
        body.velocity = {3, 0};
        body.angular_velocity = 4;
        Scene scene = with(empty_scene(), {body});
        scene.gravity = {0, falls ? -10.0 : 0.0};
        const double mass = scene.bodies[0].mass, c = z * mass * 60;
        if (quadratic) {
          scene.forces = {QuadraticDrag{"a", c}};
        } else {
          scene.forces = {LinearDrag{"a", c, c}};
        }
        Simulation world = compile(scene, Realtime{.substeps = 1});
        double before = 3, spin = 4;
        for (int i = 0; i < 600; ++i) {
          world.step();
          const BodyState now = world.state(0);
          EXPECT_GE(now.velocity.x, -kLeast) << z << quadratic;
          EXPECT_LE(now.velocity.x, before + kLeast) << z << quadratic;
          EXPECT_GE(now.angular_velocity, -kLeast) << z;
          EXPECT_LE(now.angular_velocity, spin + kLeast) << z;
          if (!quadratic && !falls && i == 0) {
            EXPECT_NEAR(now.velocity.x, 3 / (1 + z + z * z / 2), 1e-12) << z;
          }
          before = now.velocity.x, spin = now.angular_velocity;
        }
        const double terminal = !falls ? 0 : quadratic ? std::sqrt(mass * 10 / c) : mass * 10 / c;
        EXPECT_NEAR(world.state(0).velocity.y, -terminal, 1e-6 * (terminal + 1e-6)) << z << quadratic;
      }
    }
  }
}

// A torque that ends within a step still gives its exact impulse.
TEST(Flight, SwitchedTorqueGivesItsExactImpulse) {
  Scene scene = with(empty_scene(), {disc("a", {0, 0})});
  scene.forces = {Torque{"a", 2.0, 0.105, 0.2963}};
  Simulation world = compile(scene);
  world.step(60);
  EXPECT_NEAR(world.state(0).angular_velocity, 2.0 * 0.2963 / (1 * 0.25 / 2), 1e-14);
}

TEST(Flight, FixedRotationDoesNotTurnAndKinematicBodiesKeepTheirVelocity) {
  Body locked = disc("locked", {0, 0});
  locked.fixed_rotation = true;
  Body lift = disc("lift", {5, 0});
  lift.type = BodyType::Kinematic;
  lift.velocity = {0, 2};
  lift.angular_velocity = 1;
  Scene scene = with(empty_scene(), {locked, lift});
  scene.forces = {Torque{"locked", 5}};
  Simulation world = compile(scene);
  world.step(60);
  EXPECT_EQ(world.state(0).angle, 0);
  EXPECT_NEAR(world.state(1).position.y, 2, 1e-14);
  EXPECT_NEAR(world.state(1).angle, 1, 1e-14);
  EXPECT_EQ(world.state(1).velocity, (Vec2d{0, 2}));
}

}  // namespace
}  // namespace plumb
