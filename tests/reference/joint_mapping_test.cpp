// Holds each joint of a scene, as an engine gets it, against what it must do by mechanics.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "reference/backend.h"
#include "tests/reference/scenes.h"

namespace plumb::reference {
namespace {

using namespace plumb::reference::testing;

constexpr double kG = 9.81;
constexpr double kStep = 1.0 / 2000;  // s: all engines here are of first order in it
constexpr double kSlop = 0.006;  // m: Box2D leaves 5 mm (b2_linearSlop), and 1 mm for the last correction
constexpr double kAngularSlop = 0.04;  // rad: 2 degrees (b2_angularSlop), and what gravity makes of a step
constexpr double kInertia = 0.125;     // kg m^2, of all discs

/// An error of first order: the step times how fast the quantity changes, at most 1.5 times.
constexpr double first_order(double rate) { return 1.5 * kStep * rate; }

Body bob(const std::string& name, Vec2d position, double mass = 1) {
  Body out = disc(name, position, 0.1, mass);
  out.inertia = kInertia;
  return out;
}

/// A joint of body "b" with the world, and what `set` says.
template <class J, class Set>
J to_world(const Set& set) {
  J joint;
  joint.name = "joint", joint.body_a = "world", joint.body_b = "b";
  set(joint);
  return joint;
}

class JointMapping : public ::testing::TestWithParam<const char*> {
 protected:
  std::vector<BodyState> after(double duration, const Scene& scene) const {
    const Backend& engine = find_backend(GetParam());
    EXPECT_EQ(engine.unsupported(scene, steps_of(kStep)), "");
    return run(engine, scene, duration, steps_of(kStep));
  }
  BodyState after(double duration, Scene scene, Joint joint) const {
    scene.joints = {std::move(joint)};
    return after(duration, scene)[0];
  }
};

// Down a rail at 0.5 rad: s = -g sin(0.5) t^2 / 2, and nothing across.
TEST_P(JointMapping, ASliderFallsAlongItsRail) {
  const Vec2d axis{std::cos(0.5), std::sin(0.5)};
  const BodyState b =
      after(1, falling({bob("b", {0, 0})}), to_world<PrismaticJoint>([&](auto& j) { j.axis = axis; }));
  const double a = kG * std::sin(0.5);
  EXPECT_NEAR(dot(b.position, axis), -a / 2, first_order(a));
  EXPECT_NEAR(cross(b.position, axis), 0, 1e-3);
  EXPECT_NEAR(b.angle, 0, 1e-3);
}

TEST_P(JointMapping, ASliderStopsAtItsLimits) {
  for (const double sign : {1.0, -1.0}) {
    Scene scene = weightless({moving(bob("b", {0, 0}), {sign, 0})});
    const BodyState b = after(1, scene, to_world<PrismaticJoint>([&](auto& j) {
                                j.limits = Range{-0.5, 0.25};
                              }));
    EXPECT_NEAR(b.position.x, sign > 0 ? 0.25 : -0.5, kSlop);
    EXPECT_NEAR(b.velocity.x, 0, 1e-3);
  }
}

// F = 2 N on 1 kg until 0.7 m/s: x = t^2 up to 0.35 s, and on at that speed.
TEST_P(JointMapping, ASlidersMotorHasItsForceAndSpeed) {
  const PrismaticJoint joint = to_world<PrismaticJoint>([&](auto& j) { j.motor = Motor{0.7, 2}; });
  const Scene scene = weightless({bob("b", {0, 0})});
  EXPECT_NEAR(after(0.25, scene, joint).velocity.x, 0.5, first_order(2));
  const BodyState b = after(1, scene, joint);
  EXPECT_NEAR(b.velocity.x, 0.7, 1e-4);
  EXPECT_NEAR(b.position.x, 0.35 * 0.35 + 0.7 * 0.65, first_order(2));
}

TEST_P(JointMapping, AHingesMotorHasItsTorqueAndSpeedAndStopsAtItsLimit) {
  RevoluteJoint joint = to_world<RevoluteJoint>([&](auto& j) { j.motor = Motor{3, 0.5}; });
  const Scene scene = weightless({bob("b", {0, 0})});
  EXPECT_NEAR(after(0.5, scene, joint).angular_velocity, 0.5 * 0.5 / kInertia, first_order(4));
  EXPECT_NEAR(after(1.5, scene, joint).angular_velocity, 3, 1e-4);
  for (const double reference : {0.0, 0.25}) {
    joint.reference_angle = reference, joint.limits = Range{-1, 1};
    const BodyState b = after(1.5, scene, joint);
    EXPECT_NEAR(b.angle, 1 + reference, kAngularSlop);
    EXPECT_NEAR(b.angular_velocity, 0, 1e-3);
  }
}

// y = 0.1 cos(2 pi 2 t) crosses 0 after 2.25 periods; what an implicit spring damps is not seen there.
TEST_P(JointMapping, AWheelsSpringHasItsFrequency) {
  const WheelJoint joint = to_world<WheelJoint>([&](auto& j) { j.axis = {0, 1}, j.spring = Spring{2, 0}; });
  const Scene scene = weightless({bob("b", {0, 0.1})});
  const double speed = 0.1 * 2 * std::numbers::pi * 2;
  EXPECT_NEAR(after(2.25 / 2, scene, joint).position.y, 0, first_order(speed));
  EXPECT_NEAR(after(2.5 / 2, scene, joint).position.y, -0.1, 0.1 * 0.06);  // w^2 h t / 2 of it at most
}

TEST_P(JointMapping, AWheelTurnsByItsMotorAndHoldsItsLimits) {
  const WheelJoint joint = to_world<WheelJoint>([&](auto& j) {
    j.axis = {0, 1}, j.limits = Range{-0.3, 0.3}, j.motor = Motor{-4, 0.5};
  });
  const BodyState early = after(0.5, falling({bob("b", {0, 0})}), joint);
  EXPECT_NEAR(early.angular_velocity, -0.5 * 0.5 / kInertia, first_order(4));
  const BodyState b = after(2, falling({bob("b", {0, 0})}), joint);
  EXPECT_NEAR(b.angular_velocity, -4, 1e-3);
  EXPECT_NEAR(b.position.y, -0.3, kSlop);
  EXPECT_NEAR(b.position.x, 0, 1e-3);
}

// Two bodies of 1 and 3 kg: the frequency is that of their reduced mass.
TEST_P(JointMapping, ADistanceSpringHasItsFrequency) {
  Scene scene = weightless({bob("a", {0, 0}, 1), bob("b", {2.2, 0}, 3)});
  scene.joints = {
      DistanceJoint{.name = "spring", .body_a = "a", .body_b = "b", .length = 2, .spring = Spring{1.5, 0}}};
  const auto states = after(1.5, scene);
  const double speed = 0.2 * 2 * std::numbers::pi * 1.5;
  EXPECT_NEAR(states[1].position.x - states[0].position.x, 2, first_order(speed));
  // The centre of mass stays.
  EXPECT_NEAR(states[0].position.x + 3 * states[1].position.x, 6.6, 1e-4);
}

// It runs out at 1 m/s and is held at 2 m, without a rebound.
TEST_P(JointMapping, ARopeHoldsAtItsLength) {
  const DistanceJoint rope = to_world<DistanceJoint>([&](auto& j) { j.length = 1, j.range = Range{0.5, 2}; });
  const Scene scene = weightless({moving(bob("b", {1, 0}), {1, 0})});
  EXPECT_NEAR(after(0.75, scene, rope).position.x, 1.75, 1e-3);
  const BodyState b = after(2, scene, rope);
  EXPECT_NEAR(b.position.x, 2, kSlop);
  EXPECT_NEAR(b.velocity.x, 0, 1e-3);
}

TEST_P(JointMapping, AWeldedCantileverStays) {
  Scene scene = falling({box("b", {0.5, 0}, 1, 0.1)});
  scene.bodies[0].inertia = 1.0 / 12;
  const BodyState b = after(1, scene, to_world<WeldJoint>([&](auto& j) { j.anchor_b = {-0.5, 0}; }));
  EXPECT_NEAR(b.position.x, 0.5, 1e-3);
  EXPECT_NEAR(b.position.y, 0, 1e-3);
  EXPECT_NEAR(b.angle, 0, 2e-3);
}

TEST_P(JointMapping, ASoftWeldSwingsAtItsFrequency) {
  Scene scene = weightless({bob("b", {0, 0})});
  scene.bodies[0].angle = 0.1;
  const BodyState b = after(2.25 / 2, scene, to_world<WeldJoint>([&](auto& j) {
                              j.angular_spring = Spring{2, 0};
                            }));
  EXPECT_NEAR(b.angle, 0, first_order(0.1 * 2 * std::numbers::pi * 2));
  EXPECT_NEAR(b.position.x, 0, 1e-4);
}

// Critically damped towards 1 m: x = 1 - (1 + w t) exp(-w t), at most w / e fast.
TEST_P(JointMapping, AMousePullsAsItsSpringDoes) {
  const MouseJoint joint = to_world<MouseJoint>([&](auto& j) {
    j.target = {1, 0}, j.spring = Spring{3, 1}, j.max_force = 1e6;
  });
  const double w = 2 * std::numbers::pi * 3;
  const Scene scene = weightless({bob("b", {0, 0})});
  for (const double t : {0.05, 0.1, 0.2})
    EXPECT_NEAR(after(t, scene, joint).position.x, 1 - (1 + w * t) * std::exp(-w * t),
                first_order(w / std::numbers::e));
  // 2 N on 1 kg, far from the target.
  const MouseJoint weak = to_world<MouseJoint>([&](auto& j) {
    j.target = {50, 0}, j.spring = Spring{3, 1}, j.max_force = 2;
  });
  EXPECT_NEAR(after(1, scene, weak).velocity.x, 2, first_order(2));
}

// Atwood's machine with a block and tackle: T = (1 + r) g / (1/m_a + r^2/m_b), a_a = T/m_a - g upwards.
TEST_P(JointMapping, APulleyIsAtwoodsMachine) {
  for (const double ratio : {1.0, 2.0}) {
    Scene scene = falling({bob("a", {-1, 0}, 1), bob("b", {1, 0}, 3)});
    scene.joints = {PulleyJoint{.name = "rope",
                                .body_a = "a",
                                .body_b = "b",
                                .ground_a = {-1, 6},
                                .ground_b = {1, 6},
                                .ratio = ratio}};
    const double pull = (1 + ratio) * kG / (1 + ratio * ratio / 3);
    const double up_a = pull - kG, up_b = ratio * pull / 3 - kG;
    const auto states = after(1, scene);
    EXPECT_NEAR(states[0].position.y, up_a / 2, first_order(up_a)) << ratio;
    EXPECT_NEAR(states[1].position.y, up_b / 2, first_order(std::abs(up_b))) << ratio;
    EXPECT_NEAR(states[0].velocity.y, up_a, 1e-3 * kG) << ratio;
  }
}

// A wheel that turns at 5 rad/s drives another of the same inertia: w_a = 5 / (1 + r^2), w_b = r w_a.
TEST_P(JointMapping, AGearHasItsRatio) {
  for (const double ratio : {-2.0, 0.5}) {
    Scene scene = weightless({moving(bob("a", {0, 0}), {}, 5), bob("b", {1, 0})});
    scene.joints = {RevoluteJoint{.name = "axle a", .body_a = "world", .body_b = "a"},
                    RevoluteJoint{.name = "axle b", .body_a = "world", .body_b = "b", .anchor_a = {1, 0}},
                    GearJoint{.name = "gear", .body_a = "a", .body_b = "b", .ratio = ratio}};
    const auto states = after(1, scene);
    const double rate = 5 / (1 + ratio * ratio);
    EXPECT_NEAR(states[0].angular_velocity, rate, 5e-3) << ratio;
    EXPECT_NEAR(states[1].angular_velocity, ratio * rate, 5e-3) << ratio;
    EXPECT_NEAR(states[1].angle, ratio * states[0].angle, 5e-3) << ratio;
  }
}

// 2 N on 1 kg and 0.25 N m on 0.125 kg m^2: both slow down by 2 a second, from 3 to rest, and stay there.
TEST_P(JointMapping, AFrictionJointSlowsByItsForceAndTorque) {
  const FrictionJoint joint = to_world<FrictionJoint>([&](auto& j) { j.max_force = 2, j.max_torque = 0.25; });
  const Scene scene = weightless({moving(bob("b", {0, 0}), {3, 0}, 3)});
  const BodyState early = after(1, scene, joint), late = after(2, scene, joint);
  EXPECT_NEAR(early.velocity.x, 1, first_order(2));
  EXPECT_NEAR(early.angular_velocity, 1, first_order(2));
  EXPECT_NEAR(early.position.x, 2, first_order(3));
  EXPECT_NEAR(late.velocity.x, 0, 1e-4);
  EXPECT_NEAR(late.angular_velocity, 0, 1e-4);
}

INSTANTIATE_TEST_SUITE_P(All, JointMapping, ::testing::Values("box2d", "plumb-float", "plumb"),
                         [](const auto& each) {
                           std::string name = each.param;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

}  // namespace
}  // namespace plumb::reference
