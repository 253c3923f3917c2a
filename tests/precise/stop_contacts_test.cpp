#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "engine/simulation/simulation.h"
#include "tests/precise/support.h"

// Limits, ropes and motors of joints in scenes whose shapes touch, against closed forms.
namespace plumb {
namespace {

constexpr double kGravity = 9.81;
const std::string kFrame(kWorld);

Body floor_of(double friction) {
  Body floor{.name = "floor", .type = BodyType::Static, .position = {0, -0.5}};
  floor.shapes = {{.geometry = Box{200, 1}, .friction = friction}};
  return floor;
}

/// A table that slides on a vertical rail, and lies on the rail's lower end at y = 0.
void add_table(Scene& scene, double mass) {
  Body table{.name = "table", .mass = mass, .inertia = 1, .fixed_rotation = true};
  table.shapes = {{.geometry = Box{4, 1}}};
  scene.bodies.push_back(table);
  scene.joints.push_back(PrismaticJoint{
      .name = "rail", .body_a = kFrame, .body_b = "table", .axis = {0, 1}, .limits = Range{0, 50}});
}

TEST(PreciseStopsAndContacts, BallBouncesOnATableThatItsLimitHolds) {
  // The limit takes part in the impact: the table is as good as fixed, and bouncing ends when it would there.
  Scene scene{.name = "table"};
  add_table(scene, 2);
  Body ball{.name = "ball", .position = {0, 2}, .mass = 3};
  ball.shapes = {{.geometry = Circle{0.5}, .restitution = 0.5}};
  scene.bodies.push_back(ball);
  const double fall = std::sqrt(2 * 1.0 / kGravity), up = 0.5 * kGravity * fall;
  const auto driver = make_precise_driver(scene, {}, {});
  BodyState s = advance(*driver, 2, 36)[1];
  const double since = 0.6 - fall;
  ASSERT_LT(since, 2 * up / kGravity);
  EXPECT_NEAR(s.position.y, 1 + up * since - 0.5 * kGravity * since * since, 1e-12);
  const auto end = advance(*driver, 2, 120);
  EXPECT_NEAR(driver->statistics().of(ContactEvent::Rest).last, 3 * fall, 1e-9);
  EXPECT_NEAR(end[1].position.y, 1, 1e-12);
  EXPECT_NEAR(end[0].position.y, 0, 1e-12);
}

TEST(PreciseStopsAndContacts, LoadedTableLeavesItsLimitWhenTheForceSuffices) {
  // Block on table, A sin(w t) upwards: off the limit at sin(w t0) = M g / A, both together then.
  Scene scene{.name = "lift"};
  add_table(scene, 2);
  Body block{.name = "block", .position = {0, 1}, .mass = 3, .inertia = 1};
  block.shapes = {{.geometry = Box{1, 1}}};
  scene.bodies.push_back(block);
  constexpr double kForce = 60, kRate = 2;
  scene.forces = {SinusoidalForce{.body = "table", .amplitude = {0, kForce}, .angular_frequency = kRate}};
  const double from = std::asin(5 * kGravity / kForce) / kRate;
  const auto driver = make_precise_driver(scene, {}, {});
  ASSERT_LT(0.4, from);
  EXPECT_NEAR(advance(*driver, 2, 24)[1].position.y, 1, 1e-13);
  const auto s = advance(*driver, 2, 36);
  const double t = 1 - from, speed = [&](double at) {
    return kForce / 5 / kRate * (std::cos(kRate * from) - std::cos(kRate * at)) - kGravity * (at - from);
  }(1.0);
  const double height =
      kForce / 5 / kRate * (std::cos(kRate * from) * t - (std::sin(kRate) - std::sin(kRate * from)) / kRate) -
      0.5 * kGravity * t * t;
  EXPECT_NEAR(s[0].velocity.y, speed, 1e-9);
  EXPECT_NEAR(s[0].position.y, height, 1e-9);
  EXPECT_NEAR(s[1].position.y, 1 + height, 1e-9);
}

/// A cart without shapes on one driven wheel of 1 kg; it does not turn.
Scene driven_wheel(double friction) {
  Scene scene{.name = "drive"};
  Body wheel{.name = "wheel", .position = {0, 0.5}, .mass = 1, .inertia = 0.125};
  wheel.shapes = {{.geometry = Circle{0.5}, .friction = friction}};
  Body cart{.name = "cart", .position = {0, 0.5}, .mass = 3, .inertia = 1, .fixed_rotation = true};
  scene.bodies = {floor_of(friction), wheel, cart};
  scene.joints = {RevoluteJoint{.name = "axle", .body_a = "cart", .body_b = "wheel", .motor = Motor{-6, 2}}};
  return scene;
}

TEST(PreciseStopsAndContacts, MotorDrivesAWheelThatRollsUntilItsSpeed) {
  // (M R^2 + I) alpha = torque without slip, until the motor's speed; constant then.
  const double alpha = 2 / (4 * 0.25 + 0.125), reached = 6 / alpha;
  const auto driver = make_precise_driver(driven_wheel(0.9), {}, {});
  BodyState s = advance(*driver, 3, 60)[2];
  ASSERT_LT(1, reached);
  EXPECT_NEAR(s.position.x, 0.25 * alpha, 1e-11);
  s = advance(*driver, 3, 240)[2];
  EXPECT_NEAR(s.velocity.x, 3, 1e-12);
  EXPECT_NEAR(s.position.x, 1.5 * reached + 3 * (5 - reached), 1e-10);
}

TEST(PreciseStopsAndContacts, MotorSpinsAWheelThatSlipsUntilItGrips) {
  // Slipping: the cart gains mu g, the wheel (torque - mu M g R)/I until the motor's speed w at t1; held
  // there, it grips when mu g t2 = w R.
  constexpr double kFriction = 0.05;
  const double grip = kFriction * kGravity, spin = (2 - 4 * grip * 0.5) / 0.125, full = 6 / spin;
  const double rolls = 3 / grip;
  const auto driver = make_precise_driver(driven_wheel(kFriction), {}, {});
  auto s = advance(*driver, 3, 60);
  ASSERT_LT(full, 1);
  EXPECT_NEAR(s[1].angle, -(3 * full + 6 * (1 - full)), 1e-10);
  EXPECT_NEAR(s[2].position.x, grip / 2, 1e-11);
  s = advance(*driver, 3, 420);
  ASSERT_LT(rolls, 8);
  EXPECT_NEAR(s[2].position.x, 1.5 * rolls + 3 * (8 - rolls), 1e-9);
  EXPECT_NEAR(driver->statistics().of(ContactEvent::SlipEnd).last, rolls, 1e-9);
}

TEST(PreciseStopsAndContacts, RopeStopsASlidingBlock) {
  // Slides with friction, and the rope is taut before it would rest: x = v t - mu g t^2/2 up to the rope's
  // length.
  Scene scene{.name = "leash"};
  Body block{.name = "block", .position = {0, 0.5}, .velocity = {4, 0}, .inertia = 1.0 / 6};
  block.shapes = {{.geometry = Box{1, 1}, .friction = 0.2}};
  scene.bodies = {floor_of(0.2), block};
  scene.joints = {DistanceJoint{.name = "rope",
                                .body_a = kFrame,
                                .body_b = "block",
                                .anchor_a = {0, 0.5},
                                .length = 2,
                                .range = Range{0, 2}}};
  const auto driver = make_precise_driver(scene, {}, {});
  const double slow = 0.2 * kGravity;
  EXPECT_NEAR(advance(*driver, 2, 30)[1].position.x, 2 - slow / 8, 1e-12);
  const BodyState s = advance(*driver, 2, 60)[1];
  EXPECT_NEAR(s.position.x, 2, 1e-12);
  EXPECT_NEAR(s.velocity.x, 0, 1e-12);
  EXPECT_NEAR(s.position.y, 0.5, 1e-12);
}

TEST(PreciseStopsAndContacts, SavedAndRestoredRunsGoOnWithTheSameBits) {
  Simulation one = compile(driven_wheel(0.05), Precise{});
  for (const int steps : {20, 40, 320}) {
    one.step(steps);
    const auto saved = one.save();
    Simulation other = compile(driven_wheel(0.05), Precise{});
    other.restore(saved);
    one.step(9), other.step(9);
    EXPECT_EQ(one.hash(), other.hash()) << steps;
  }
}

}  // namespace
}  // namespace plumb
