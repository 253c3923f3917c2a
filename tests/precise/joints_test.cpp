#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "engine/scene/error.h"
#include "engine/simulation/simulation.h"
#include "tests/precise/support.h"
#include "tests/precise/truth.h"

// Joints of all kinds under Precise, against closed forms and equations in coordinates of their own.
namespace plumb {
namespace {

using truth::Real;

constexpr double kGravity = 9.81;
const std::string kFrame(kWorld);

Body bead(const std::string& name, Vec2d position, double mass = 1) {
  return {.name = name, .position = position, .mass = mass, .inertia = 1, .fixed_rotation = true};
}

/// A damped oscillator x'' = -w^2 x - 2 zeta w x' from x(0), x'(0) = 0, zeta < 1.
double ringing(double x, double hertz, double zeta, double t) {
  const double w = 2 * kPi * hertz, d = w * std::sqrt(1 - zeta * zeta);
  return x * std::exp(-zeta * w * t) * (std::cos(d * t) + zeta * w / d * std::sin(d * t));
}

TEST(PreciseJoints, PulleyOfAnyRatioFallsAsAtwoods) {
  // With l_a + r l_b constant and T the tension at a: l_a'' = g - T/m_a, l_b'' = g - r T/m_b.
  for (const double ratio : {1.0, 2.5}) {
    Scene scene{.name = "atwood"};
    scene.bodies = {bead("a", {-1, 0}, 3), bead("b", {1, 0}, 2)};
    scene.joints = {PulleyJoint{.name = "rope",
                                .body_a = "a",
                                .body_b = "b",
                                .ground_a = {-1, 5},
                                .ground_b = {1, 5},
                                .ratio = ratio}};
    const auto s = run(scene, 60);
    const double tension = kGravity * (1 + ratio) / (1.0 / 3 + ratio * ratio / 2);
    EXPECT_NEAR(s[0].position.y, -0.5 * (kGravity - tension / 3), 1e-13) << ratio;
    EXPECT_NEAR(s[1].position.y, -0.5 * (kGravity - ratio * tension / 2), 1e-13) << ratio;
    EXPECT_NEAR(s[1].velocity.y, -(kGravity - ratio * tension / 2), 2e-13) << ratio;
  }
}

TEST(PreciseJoints, SwingingAtwoodMachine) {
  // N. Tufillaro, T. Abbott, D. Griffiths 1984: (M + m) r'' = m r q'^2 - M g + m g cos q,
  // r q'' = -2 r' q' - g sin q; r from its pulley to m, q from the vertical.
  constexpr Real heavy = 3, light = 1, g = 9.81L;
  Scene scene{.name = "swinging"};
  scene.bodies = {bead("heavy", {-2, -1}, 3), bead("light", {1 + std::sin(0.9), -std::cos(0.9)}, 1)};
  scene.joints = {PulleyJoint{
      .name = "rope", .body_a = "heavy", .body_b = "light", .ground_a = {-2, 0}, .ground_b = {1, 0}}};
  const truth::Rate rate = [&](Real, const std::vector<Real>& y, std::vector<Real>& out) {
    out = {y[2], y[3],
           (light * y[0] * y[3] * y[3] - heavy * g + light * g * std::cos(y[1])) / (heavy + light),
           -(2 * y[2] * y[3] + g * std::sin(y[1])) / y[0]};
  };
  scene.bodies[1].position = {1 + 3 * std::sin(0.9), -3 * std::cos(0.9)};
  const auto y = truth::integrate_twice(rate, {3, 0.9L, 0, 0}, 0, 0.5L, 2000);
  const auto s = run(scene, 30);
  EXPECT_NEAR(s[1].position.x, static_cast<double>(1 + y[0] * std::sin(y[1])), 1e-12);
  EXPECT_NEAR(s[1].position.y, static_cast<double>(-y[0] * std::cos(y[1])), 1e-12);
  EXPECT_NEAR(s[0].position.y, static_cast<double>(y[0] - 4), 1e-12);
}

TEST(PreciseJoints, SliderOnASpringRingsAtItsFrequency) {
  // Along the axis n: q'' = -w^2 (q - target) - 2 zeta w q' + g . n, about q = target + g . n / w^2.
  const Vec2d n{0.6, 0.8};
  const double hertz = 1.5, zeta = 0.2, w = 2 * kPi * hertz, target = 0.3;
  Scene scene{.name = "slider"};
  scene.bodies = {{.name = "slider", .mass = 2, .inertia = 0.7}};
  scene.joints = {PrismaticJoint{.name = "rail",
                                 .body_a = kFrame,
                                 .body_b = "slider",
                                 .axis = 5.0 * n,
                                 .spring = Spring{hertz, zeta},
                                 .target_translation = target}};
  const double rest = target - kGravity * n.y / (w * w);
  for (const MotionMethod method : {MotionMethod::Explicit, MotionMethod::Implicit}) {
    const BodyState s = run(scene, 60, {.method = method})[0];
    const double q = rest + ringing(-rest, hertz, zeta, 1);
    EXPECT_NEAR(s.position.x, q * n.x, 2e-12);
    EXPECT_NEAR(s.position.y, q * n.y, 2e-12);
    EXPECT_NEAR(s.angle, 0, 1e-14);
  }
}

TEST(PreciseJoints, SliderOnATurningRodFliesOut) {
  // No gravity: L = (I + J + m r^2) w is constant, r'' = r w^2; I and J the inertias of rod and slider.
  Scene scene{.name = "governor", .gravity = {}};
  scene.bodies = {
      {.name = "rod", .angular_velocity = 3, .mass = 2, .inertia = 0.5},
      {.name = "slider", .position = {0.4, 0}, .velocity = {0, 1.2}, .angular_velocity = 3, .inertia = 0.1}};
  scene.joints = {RevoluteJoint{.name = "pin", .body_a = kFrame, .body_b = "rod"},
                  PrismaticJoint{.name = "rail", .body_a = "rod", .body_b = "slider"}};
  const Real total = (0.6L + 0.16L) * 3;
  const truth::Rate rate = [&](Real, const std::vector<Real>& y, std::vector<Real>& out) {
    const Real w = total / (0.6L + y[0] * y[0]);
    out = {y[1], y[0] * w * w, w};
  };
  const auto y = truth::integrate_twice(rate, {0.4L, 0, 0}, 0, 1, 2000);
  for (const MotionMethod method : {MotionMethod::Explicit, MotionMethod::Implicit}) {
    const auto s = run(scene, 60, {.method = method});
    EXPECT_NEAR(s[0].angle, static_cast<double>(y[2]), 2e-12);
    EXPECT_NEAR(s[1].angle, static_cast<double>(y[2]), 2e-12);
    EXPECT_NEAR(s[1].position.x, static_cast<double>(y[0] * std::cos(y[2])), 2e-12);
    EXPECT_NEAR(s[1].position.y, static_cast<double>(y[0] * std::sin(y[2])), 2e-12);
  }
}

TEST(PreciseJoints, WeldedBodiesFlyAsOne) {
  // The common centre of mass is thrown, and everything turns about it at a constant rate.
  const double spin = 4, m = 1, mass = 3, distance = 2;
  const double left = mass / (m + mass) * distance, right = m / (m + mass) * distance;
  Scene scene{.name = "welded"};
  scene.bodies = {{.name = "a",
                   .position = {-left, 0},
                   .velocity = {1, 2 - spin * left},
                   .angular_velocity = spin,
                   .mass = m,
                   .inertia = 0.2},
                  {.name = "b",
                   .position = {right, 0},
                   .angle = 0.5,
                   .velocity = {1, 2 + spin * right},
                   .angular_velocity = spin,
                   .mass = mass,
                   .inertia = 0.3}};
  const Rotation<double> back{std::cos(0.5), -std::sin(0.5)};
  scene.joints = {WeldJoint{.name = "seam",
                            .body_a = "a",
                            .body_b = "b",
                            .anchor_a = {0.5, 0.1},
                            .anchor_b = back * Vec2d{0.5 - distance, 0.1},
                            .reference_angle = 0.5}};
  const auto s = run(scene, 60);
  const Vec2d centre{1, 2 - kGravity / 2}, way{std::cos(spin), std::sin(spin)};
  EXPECT_NEAR(s[0].position.x, centre.x - left * way.x, 1e-12);
  EXPECT_NEAR(s[0].position.y, centre.y - left * way.y, 1e-12);
  EXPECT_NEAR(s[1].position.y, centre.y + right * way.y, 1e-12);
  EXPECT_NEAR(s[1].angle, 0.5 + spin, 1e-12);
}

TEST(PreciseJoints, GearsCarryEachOthersInertia) {
  // A wheel hung off its centre by d, geared to another: (I + m d^2 + ratio^2 J) q'' = -m g d sin q.
  const Real inertia = 0.5L, arm = 0.3L, mass = 2, other = 0.2L, ratio = -1.5L, g = 9.81L;
  Scene scene{.name = "gears"};
  scene.bodies = {{.name = "a",
                   .position = {0.3 * std::sin(1.2), -0.3 * std::cos(1.2)},
                   .angle = 1.2,
                   .mass = 2,
                   .inertia = 0.5},
                  {.name = "b", .position = {5, 0}, .angle = -1.5 * 1.2, .inertia = 0.2}};
  scene.joints = {RevoluteJoint{.name = "axle a", .body_a = kFrame, .body_b = "a", .anchor_b = {0, 0.3}},
                  RevoluteJoint{.name = "axle b", .body_a = kFrame, .body_b = "b", .anchor_a = {5, 0}},
                  GearJoint{.name = "gear", .body_a = "a", .body_b = "b", .ratio = -1.5}};
  const Real whole = inertia + mass * arm * arm + ratio * ratio * other;
  const truth::Rate rate = [&](Real, const std::vector<Real>& y, std::vector<Real>& out) {
    out = {y[1], -mass * g * arm * std::sin(y[0]) / whole};
  };
  const auto y = truth::integrate_twice(rate, {1.2L, 0}, 0, 2, 2000);
  const auto driver = make_precise_driver(scene, {}, {});
  const auto s = advance(*driver, 2, 120);
  EXPECT_NEAR(s[0].angle, static_cast<double>(y[0]), 1e-11);
  EXPECT_NEAR(s[1].angle, static_cast<double>(ratio * y[0]), 2e-11);
  const double energy = 0.5 * static_cast<double>(whole) * s[0].angular_velocity * s[0].angular_velocity +
                        2 * kGravity * s[0].position.y;
  EXPECT_NEAR(energy, -2 * kGravity * 0.3 * std::cos(1.2), 1e-11);
}

TEST(PreciseJoints, SuspensionRingsAtItsFrequency) {
  // Chassis and wheel with no gravity: their distance along the axis is a damped oscillator, their centre of
  // mass stays, and the wheel spins on.
  Scene scene{.name = "suspension", .gravity = {}};
  scene.bodies = {bead("chassis", {0, 1.2}, 5),
                  {.name = "wheel", .position = {0, 0}, .angular_velocity = 7, .mass = 0.5, .inertia = 0.02}};
  scene.joints = {WheelJoint{.name = "strut",
                             .body_a = "chassis",
                             .body_b = "wheel",
                             .anchor_a = {0, -1},
                             .axis = {0, 1},
                             .spring = Spring{4, 0.3}}};
  const auto s = run(scene, 30);
  const double q = ringing(-0.2, 4, 0.3, 0.5), centre = 1.2 * 5 / 5.5;
  EXPECT_NEAR(s[1].position.y - (s[0].position.y - 1), q, 2e-12);
  EXPECT_NEAR((5 * s[0].position.y + 0.5 * s[1].position.y) / 5.5, centre, 1e-13);
  EXPECT_NEAR(s[1].angle, 3.5, 1e-12);
  EXPECT_NEAR(s[1].position.x, 0, 1e-15);
}

TEST(PreciseJoints, SpringsOfHingesRodsAndWeldsRingAtTheirFrequencies) {
  Scene scene{.name = "springs", .gravity = {}};
  scene.bodies = {{.name = "door", .angle = 0.7, .inertia = 3},
                  bead("left", {0, 5}, 2),
                  bead("right", {1.4, 5}, 3),
                  bead("p", {0, 9}, 2),
                  {.name = "q", .position = {0.3, 9.2}, .mass = 3, .inertia = 1, .fixed_rotation = true},
                  {.name = "vane", .position = {9, 0}, .angle = 3.5, .inertia = 0.4}};
  scene.joints = {
      RevoluteJoint{
          .name = "hinge", .body_a = kFrame, .body_b = "door", .spring = Spring{2, 0.1}, .target_angle = 0.2},
      DistanceJoint{.name = "coil", .body_a = "left", .body_b = "right", .length = 1, .spring = Spring{3, 0}},
      WeldJoint{.name = "pad", .body_a = "p", .body_b = "q", .linear_spring = Spring{1, 0.5}},
      WeldJoint{.name = "blade",
                .body_a = kFrame,
                .body_b = "vane",
                .anchor_a = {9, 0},
                .reference_angle = 3,
                .angular_spring = Spring{1.5, 0}}};
  for (const MotionMethod method : {MotionMethod::Explicit, MotionMethod::Implicit}) {
    const auto s = run(scene, 60, {.method = method});
    EXPECT_NEAR(s[0].angle, 0.2 + ringing(0.5, 2, 0.1, 1), 1e-11);
    EXPECT_NEAR(s[2].position.x - s[1].position.x, 1 + ringing(0.4, 3, 0, 1), 1e-11);
    EXPECT_NEAR(s[4].position.x - s[3].position.x, ringing(0.3, 1, 0.5, 1), 1e-11);
    EXPECT_NEAR(s[4].position.y - s[3].position.y, ringing(0.2, 1, 0.5, 1), 1e-11);
    EXPECT_NEAR(s[5].angle, 3 + ringing(0.5, 1.5, 0, 1), 1e-11);
    EXPECT_NEAR(s[5].position.x, 9, 1e-14);
  }
}

TEST(PreciseJoints, PullOfBoundedStrengthIsConstantUntilItsSpringIsWeaker) {
  // x'' = -F/m down to x = F/(m w^2), then harmonic. From x = 2 at rest with F/m = 8, w = 4: to x = 0.5 with
  // speed sqrt(2 8 1.5), in t = speed/8.
  Scene scene{.name = "mouse", .gravity = {}};
  scene.bodies = {bead("body", {2, 0}, 3)};
  scene.joints = {MouseJoint{.name = "mouse",
                             .body_a = kFrame,
                             .body_b = "body",
                             .spring = Spring{4 / (2 * kPi), 0},
                             .max_force = 24}};
  const double speed = std::sqrt(24.0), left = 0.8 - speed / 8;
  const BodyState s = run(scene, 48)[0];
  EXPECT_NEAR(s.position.x, 0.5 * std::cos(4 * left) - speed / 4 * std::sin(4 * left), 1e-10);
}

TEST(PreciseJoints, StiffSpringsOfJointsCostWhatSlowOnesDo) {
  // A spring of 1000 Hz, critically damped, under a slow one: the slow motion alone is left.
  Scene scene{.name = "stiff", .gravity = {}};
  scene.bodies = {bead("slow", {0.5, 0}, 1e6), bead("fast", {0.5, 0}, 1)};
  scene.joints = {
      PrismaticJoint{.name = "slow rail", .body_a = kFrame, .body_b = "slow", .spring = Spring{1, 0}},
      PrismaticJoint{.name = "fast rail", .body_a = "slow", .body_b = "fast", .spring = Spring{1000, 1}}};
  const auto driver = make_precise_driver(scene, {.tolerance = 1e-6}, {});
  const auto s = advance(*driver, 2, 30);
  EXPECT_NEAR(s[0].position.x, ringing(0.5, 1, 0, 0.5), 1e-6);  // to the share of the light body's mass
  EXPECT_GT(driver->statistics().implicit, 0);
  EXPECT_LT(driver->statistics().evaluations, 5000);
}

TEST(PreciseJoints, WhatIsLackingIsSaid) {
  Scene scene{.name = "lacking"};
  scene.bodies = {{.name = "arm", .inertia = 1}};
  RevoluteJoint hinge{.name = "hip", .body_a = kFrame, .body_b = "arm"};
  hinge.break_force = 10;
  scene.joints = {hinge};
  EXPECT_EQ(precise_unsupported(scene),
            "joint 'hip' has break_force, which Precise does not have; 'plumb' runs it");
  scene.joints = {RatchetJoint{.name = "click", .body_a = kFrame, .body_b = "arm"}};
  EXPECT_EQ(precise_unsupported(scene),
            "joint 'click' is a ratchet joint, which Precise does not have; 'plumb' runs it");
}

}  // namespace
}  // namespace plumb
