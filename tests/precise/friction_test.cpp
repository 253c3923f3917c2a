#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/precise/contact_scenes.h"
#include "tests/precise/truth.h"

namespace plumb {
namespace {

using truth::Real;

Scene on_ramp(double angle, double friction, bool is_disc) {
  Scene scene{.name = "ramp", .gravity = gravity_on_ramp(angle)};
  scene.bodies = {ground(friction), is_disc ? disc("body", {0, 0.5}, {}, 0.5, friction)
                                            : block("body", {0, 0.25}, 2, 0.5, friction)};
  return scene;
}

TEST(PreciseFriction, BlockOnARamp) {
  for (const double angle : {0.05, 0.3, 0.7, 1.1}) {
    for (const double mu : {0.0, 0.1, 0.4, 0.9}) {
      const auto s = run(on_ramp(angle, mu, false), 60);
      const Vec2d g = gravity_on_ramp(angle);
      // Toppling is kept out of it: half-width 1, half-height 0.25.
      const double a = std::max(0.0, g.x + mu * g.y);
      EXPECT_NEAR(s[1].velocity.x, a, 1e-12) << angle << " " << mu;
      EXPECT_NEAR(s[1].position.x, a / 2, 1e-12) << angle << " " << mu;
      EXPECT_NEAR(s[1].position.y, 0.25, 1e-14);
    }
  }
}

TEST(PreciseFriction, TheLineBetweenStickAndSlip) {
  for (const double angle : {0.05, 0.3, 0.7, 1.1}) {
    const double line = std::tan(angle);
    EXPECT_EQ(run(on_ramp(angle, line * (1 + 1e-9), false), 30)[1].velocity.x < 1e-13, true) << angle;
    const double a = run(on_ramp(angle, line * (1 - 1e-9), false), 60)[1].velocity.x;
    EXPECT_NEAR(a / (9.81e-9 * std::sin(angle)), 1, 1e-5) << angle;
  }
}

TEST(PreciseFriction, DiscOnARamp) {
  for (const double angle : {0.05, 0.3, 0.7, 1.1}) {
    const double line = std::tan(angle) / 3;
    for (const double mu : {0.0, 0.5 * line, line - 1e-6, line + 1e-6, 2 * line}) {
      const auto s = run(on_ramp(angle, mu, true), 60);
      const double a =
          mu > line ? 2.0 / 3 * 9.81 * std::sin(angle) : 9.81 * (std::sin(angle) - mu * std::cos(angle));
      const double spin = mu > line ? -a / 0.5 : -2 * mu * 9.81 * std::cos(angle) / 0.5;
      EXPECT_NEAR(s[1].velocity.x, a, 1e-11) << angle << " " << mu;
      EXPECT_NEAR(s[1].angular_velocity, spin, 1e-11) << angle << " " << mu;
    }
  }
}

TEST(PreciseFriction, SlidingDiscStartsToRoll) {
  // t = v0/(3 mu g), v = 2 v0/3, x = 5 v0^2/(18 mu g).
  Scene scene{.name = "roll"};
  scene.bodies = {ground(0.2), disc("disc", {0, 0.5}, {5, 0}, 0.5, 0.2)};
  const auto driver = make_precise_driver(scene, {}, {});
  const auto s = advance(*driver, 2, 120);
  const Real t = 5 / (3 * 0.2L * 9.81L), x = 25 * 5 / (18 * 0.2L * 9.81L);
  EXPECT_EQ(events(*driver, ContactEvent::SlipEnd).count, 1);
  EXPECT_NEAR(events(*driver, ContactEvent::SlipEnd).last, static_cast<double>(t), 1e-12);
  EXPECT_NEAR(s[1].velocity.x, 10.0 / 3, 1e-13);
  EXPECT_NEAR(s[1].position.x, static_cast<double>(x + (2 - t) * 10 / 3), 1e-12);
  EXPECT_NEAR(s[1].velocity.x + 0.5 * s[1].angular_velocity, 0, 1e-14);
}

TEST(PreciseFriction, BlockOnAShakenPlateSticksAndSlips) {
  // A plate on springs of its own force law would do; here a force that is switched on breaks the grip, and
  // the block comes to rest again t = v/(mu g) after it ends.
  const double mu = 0.3, g = 9.81;
  Scene scene{.name = "pull"};
  scene.bodies = {ground(mu), block("block", {0, 0.25}, 1, 0.5, mu)};
  scene.forces = {PointForce{"block", {5, 0}, {0, -0.2}, Frame::World, 0.5, 0.75}};
  const auto driver = make_precise_driver(scene, {}, {});
  const auto s = advance(*driver, 2, 120);
  const Real a = 5 - static_cast<Real>(mu) * 9.81L, v = a * 0.75L, t = 1.25L + v / (mu * g);
  EXPECT_NEAR(events(*driver, ContactEvent::SlipEnd).last, static_cast<double>(t), 1e-11);
  EXPECT_NEAR(s[1].position.x, static_cast<double>(a * 0.75L * 0.75L / 2 + v * v / (2 * mu * g)), 1e-11);
  EXPECT_NEAR(s[1].velocity.x, 0, 1e-14);
}

TEST(PreciseFriction, GripBreaksWhenAGrowingForceReachesTheCone) {
  // The pull grows with the square of the speed that drag is given by: a block on a moving belt is braked by
  // a quadratic drag; it slips as soon as c v^2 > mu m g, and goes on at that speed.
  const double mu = 0.5, g = 9.81;
  Scene scene{.name = "belt"};
  Body belt = block("belt", {0, -0.5}, 400, 1, mu);
  belt.type = BodyType::Kinematic;
  belt.velocity = {4, 0};
  scene.bodies = {belt, block("block", {0, 0.25}, 1, 0.5, mu)};
  scene.bodies[1].velocity = {4, 0};
  scene.bodies[1].inertia = 1e6;
  scene.forces = {QuadraticDrag{"block", 1.0}};
  const auto s = run(scene, 600);
  EXPECT_NEAR(s[1].velocity.x, std::sqrt(mu * g), 1e-9);
  scene.forces = {QuadraticDrag{"block", 0.3}};  // 4.8 N < mu m g
  EXPECT_NEAR(run(scene, 60)[1].velocity.x, 4, 1e-13);
}

TEST(PreciseFriction, DiscLandsWithSlip) {
  // J_t = -m u/3, at most mu (1 + e) m |v_n|.
  for (const double mu : {0.05, 0.5}) {
    Scene scene{.name = "land"};
    scene.bodies = {ground(mu, 0.5), disc("disc", {0, 1.5}, {3, 0}, 0.5, mu, 0.5)};
    const auto s = run(scene, 30);
    const double v = std::sqrt(2 * 9.81), rub = std::min(1.0, mu * 1.5 * v);
    EXPECT_NEAR(s[1].velocity.x, 3 - rub, 1e-13);
    EXPECT_NEAR(s[1].angular_velocity, -rub * 0.5 / 0.125, 1e-12);
  }
}

TEST(PreciseFriction, DiscsOnAPlateThatIsPulled) {
  // Each disc accelerates at a third of the plate's acceleration; the plate carries a third of their mass.
  Scene scene{.name = "plate"};
  scene.bodies = {ground(0), block("plate", {0, 0.1}, 20, 0.2, 0.8), disc("left", {-3, 0.7}, {}, 0.5, 0.8),
                  disc("right", {3, 0.6}, {}, 0.4, 0.8)};
  scene.contact_rules.friction = Combine::Product;
  scene.forces = {PointForce{"plate", {6, 0}, {0, -0.1}}};
  const auto s = run(scene, 60);
  const double a = 6 / (1 + 2.0 / 3);
  EXPECT_NEAR(s[1].velocity.x, a, 1e-11);
  EXPECT_NEAR(s[2].velocity.x, a / 3, 1e-11);
  EXPECT_NEAR(s[3].velocity.x, a / 3, 1e-11);
}

TEST(PreciseFriction, PainlevesRodIsJammedByAnImpulse) {
  // mu > 4/3: a rod that slips towards its lean cannot be held by any force at its end. The impulse stops its
  // slip: the end is at rest afterwards, angular momentum about it is what it was.
  const double angle = 1.0, mu = 2.5;
  Scene scene{.name = "painleve"};
  scene.bodies = {ground(mu), rod_on_a_box("rod", {0, std::sin(angle)}, angle, mu)};
  scene.bodies[1].velocity = {-3, 0};
  const auto driver = make_precise_driver(scene, {.max_dt = 1e-9}, {});
  const auto s = advance(*driver, 2, 1)[1];
  EXPECT_EQ(events(*driver, ContactEvent::Paradox).count, 1);
  const double about_end = std::sin(angle) * 3 / (4.0 / 3);  // r x v over the inertia about the end
  EXPECT_NEAR(s.angular_velocity, about_end, 1e-7);
  EXPECT_NEAR(s.velocity.x, -about_end * std::sin(angle), 1e-7);
  EXPECT_NEAR(s.velocity.y, about_end * std::cos(angle), 1e-7);
}

TEST(PreciseFriction, SlidingBlockTripsOverItsFrontWhereItIsRough) {
  // mu = 5 at the front corner of a block of half sizes b, h: no force holds it while it slips. It is stopped
  // there at once, its angular momentum about the corner kept, w = m v h / (I + m (b^2 + h^2)), and turns
  // about it as a pendulum upside down: q'' = -m g r cos(q0 + q) / (I + m r^2).
  constexpr double kHalf = 0.5, kHeight = 0.25, kInertia = 0.1, kSpeed = 3;
  Scene scene{.name = "trip"};
  scene.bodies = {ground(5), block("block", {0, kHeight}, 2 * kHalf, 2 * kHeight, 5)};
  scene.bodies[1].mass = 1, scene.bodies[1].inertia = kInertia, scene.bodies[1].velocity = {kSpeed, 0};
  const auto driver = make_precise_driver(scene, {}, {});
  const auto s = advance(*driver, 2, 12)[1];
  EXPECT_EQ(events(*driver, ContactEvent::Paradox).count, 1);
  const double arm2 = kHalf * kHalf + kHeight * kHeight, about = kInertia + arm2;
  const Real lean = std::atan2(Real(kHeight), Real(-kHalf)), arm = std::sqrt(Real(arm2));
  const auto y = truth::integrate_twice(
      [&](Real, const std::vector<Real>& q, std::vector<Real>& out) {
        out = {q[1], -9.81L * arm * std::cos(lean + q[0]) / about};
      },
      {0, -kSpeed * kHeight / about}, 0, 0.2L, 400);
  EXPECT_NEAR(s.angle, static_cast<double>(y[0]), 1e-10);
  EXPECT_NEAR(s.angular_velocity, static_cast<double>(y[1]), 1e-10);
  EXPECT_NEAR(s.position.x, static_cast<double>(kHalf + arm * std::cos(lean + y[0])), 1e-10);
}

TEST(PreciseFriction, WhateverFallsOnRoughFloorsFindsItsForces) {
  // Energy is all that is known of these: friction and impacts without restitution only take it.
  for (const double friction : {1.0, 5.0, 20.0}) {
    for (const double speed : {0.5, -3.0, 10.0}) {
      for (const double spin : {0.0, 8.0}) {
        for (const bool rounded : {false, true}) {
          Scene scene{.name = "rough"};
          Body body{.name = "body",
                    .position = {0, 0.5},
                    .angle = 0.3,
                    .velocity = {speed, 0},
                    .angular_velocity = spin,
                    .inertia = 0.1};
          body.shapes = {{.geometry = Box{1, 0.5}, .friction = friction}};
          if (rounded) body.shapes[0].geometry = Capsule{{-0.5, 0}, {0.5, 0}, 0.25};
          scene.bodies = {ground(friction), body};
          const auto driver = make_precise_driver(scene, {.tolerance = 1e-6}, {});
          double energy = 1e9;
          for (int i = 0; i < 24; ++i) {
            const auto s = advance(*driver, 2, 5)[1];
            const double now = 0.5 * length_squared(s.velocity) +
                               0.05 * s.angular_velocity * s.angular_velocity + 9.81 * s.position.y;
            EXPECT_LT(now, energy + 1e-5) << friction << " " << speed << " " << spin << " " << rounded;
            energy = now;
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace plumb
