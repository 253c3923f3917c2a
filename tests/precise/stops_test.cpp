#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "engine/simulation/simulation.h"
#include "tests/precise/support.h"

// Limits and motors of joints under Precise, against closed forms.
namespace plumb {
namespace {

constexpr double kGravity = 9.81;
const std::string kFrame(kWorld);

Body bead(const std::string& name, Vec2d position, double mass = 1) {
  return {.name = name, .position = position, .mass = mass, .inertia = 1, .fixed_rotation = true};
}

TEST(PreciseStops, SliderFallsOntoItsLimitAndRests) {
  Scene scene{.name = "fall"};
  scene.bodies = {bead("slider", {0, 0})};
  scene.joints = {PrismaticJoint{
      .name = "rail", .body_a = kFrame, .body_b = "slider", .axis = {0, 1}, .limits = Range{-1.3, 2}}};
  const auto driver = make_precise_driver(scene, {}, {});
  const double hit = std::sqrt(2 * 1.3 / kGravity);
  BodyState s = advance(*driver, 1, 30)[0];
  ASSERT_LT(0.5, hit);
  EXPECT_NEAR(s.position.y, -kGravity / 8, 1e-13);
  s = advance(*driver, 1, 60)[0];
  EXPECT_NEAR(s.position.y, -1.3, 1e-13);
  EXPECT_NEAR(s.velocity.y, 0, 1e-14);
  EXPECT_EQ(driver->statistics().impacts, 1);
}

TEST(PreciseStops, PushedOffItsLimitWhenTheForceTurns) {
  // A force of sin(2 t) along the rail, from rest on the lower limit: x = t/2 - sin(2 t)/4 as long as it is
  // positive, which it is.  With phase pi it presses first, until t = pi/2.
  Scene scene{.name = "release", .gravity = {}};
  scene.bodies = {bead("slider", {0, 0})};
  scene.joints = {
      PrismaticJoint{.name = "rail", .body_a = kFrame, .body_b = "slider", .limits = Range{0, 9}}};
  SinusoidalForce force{.body = "slider", .amplitude = {1, 0}, .angular_frequency = 2, .phase = kPi};
  scene.forces = {force};
  const BodyState s = run(scene, 180)[0];
  const double t = 3 - kPi / 2;
  EXPECT_NEAR(s.position.x, t / 2 - std::sin(2 * t) / 4, 1e-10);
  EXPECT_NEAR(s.velocity.x, (1 - std::cos(2 * t)) / 2, 1e-10);
}

TEST(PreciseStops, MotorReachesItsSpeedAndHoldsIt) {
  // A wheel of inertia I on an axle: torque M until w = 5 at t = I 5 / M, then 5.
  Scene scene{.name = "motor"};
  scene.bodies = {{.name = "wheel", .mass = 3, .inertia = 0.8}};
  scene.joints = {RevoluteJoint{.name = "axle", .body_a = kFrame, .body_b = "wheel", .motor = Motor{5, 6}}};
  const double reached = 0.8 * 5 / 6;
  const BodyState s = run(scene, 120)[0];
  EXPECT_NEAR(s.angular_velocity, 5, 1e-12);
  EXPECT_NEAR(s.angle, 2.5 * reached + 5 * (2 - reached), 1e-11);
}

TEST(PreciseStops, BrakeHoldsUntilTheForceIsStronger) {
  // A motor of speed 0 and 2 N against 3 sin(t): it gives way at t0 = asin(2/3), then x'' = 3 sin t - 2.
  Scene scene{.name = "brake", .gravity = {}};
  scene.bodies = {bead("slider", {0, 0})};
  scene.joints = {PrismaticJoint{.name = "rail", .body_a = kFrame, .body_b = "slider", .motor = Motor{0, 2}}};
  scene.forces = {SinusoidalForce{.body = "slider", .amplitude = {3, 0}, .angular_frequency = 1}};
  const double from = std::asin(2.0 / 3);
  for (const int steps : {42, 90}) {
    const double t = steps / 60.0, since = t - from;
    const BodyState s = run(scene, steps)[0];
    const double x = 3 * std::cos(from) * since - 3 * (std::sin(t) - std::sin(from)) - since * since;
    EXPECT_NEAR(s.position.x, since < 0 ? 0 : x, 1e-10) << steps;
    EXPECT_NEAR(s.velocity.x, since < 0 ? 0 : 3 * (std::cos(from) - std::cos(t)) - 2 * since, 1e-10) << steps;
  }
}

TEST(PreciseStops, RopeSnapsTautAndSwings) {
  // A bob thrown sideways from under its anchor, where the rope is slack by half a metre below: it falls
  // freely until its distance is the rope's length, loses its radial speed there, and is a pendulum then,
  // whose energy is kept.
  Scene scene{.name = "rope"};
  scene.bodies = {bead("bob", {0.6, 0})};
  scene.joints = {
      DistanceJoint{.name = "rope", .body_a = kFrame, .body_b = "bob", .length = 1, .range = Range{0, 1}}};
  // |(0.6, -g t^2 / 2)| = 1: g t^2 / 2 = 0.8; the speed g t, its share along the rope 0.8 of it.
  const double fall = std::sqrt(1.6 / kGravity), speed = kGravity * fall * 0.6;
  const auto driver = make_precise_driver(scene, {}, {});
  const int steps = 45;
  ASSERT_LT(fall, 0.75);
  const BodyState s = advance(*driver, 1, steps)[0];
  EXPECT_NEAR(std::sqrt(length_squared(s.position)), 1, 1e-13);
  EXPECT_NEAR(length_squared(s.velocity) / 2 + kGravity * s.position.y, speed * speed / 2 - kGravity * 0.8,
              1e-10);
  EXPECT_EQ(driver->statistics().impacts, 1);
}

TEST(PreciseStops, DoorBetweenItsStops) {
  // A door that swings freely is stopped dead at its stop; a spring takes it back from there.
  Scene scene{.name = "door", .gravity = {}};
  scene.bodies = {{.name = "door", .angular_velocity = 2, .inertia = 3}};
  scene.joints = {RevoluteJoint{.name = "hinge",
                                .body_a = kFrame,
                                .body_b = "door",
                                .limits = Range{-1, 0.5},
                                .spring = Spring{0.5, 0}}};
  // q = (2/w) sin(w t) with w = pi reaches 0.5 at asin(pi/4)/pi; then 0.5 cos(w (t - that)).
  const double hit = std::asin(kPi / 4) / kPi;
  const BodyState s = run(scene, 45)[0];
  EXPECT_NEAR(s.angle, 0.5 * std::cos(kPi * (0.75 - hit)), 1e-10);
}

TEST(PreciseStops, ChainWithStopsLosesEnergyOnlyAndKeepsWithinThem) {
  // Limits do no work while they hold and take energy when they are met.
  Scene scene = rods(5);
  for (std::size_t i = 1; i < scene.joints.size(); ++i)
    std::get<RevoluteJoint>(scene.joints[i]).limits = Range{-0.4, 0.6};
  const auto driver = make_precise_driver(scene, {}, {});
  double energy = 0;
  for (int i = 0; i < 120; ++i) {
    const auto s = advance(*driver, 5, 1);
    const RodsCheck now = check_rods(s);
    EXPECT_LT(now.energy, energy + 1e-10) << i;
    EXPECT_LT(now.gap, 1e-13) << i;
    energy = now.energy;
    for (int k = 1; k < 5; ++k) {
      EXPECT_GT(s[k].angle - s[k - 1].angle, -0.4 - 1e-12) << i << " " << k;
      EXPECT_LT(s[k].angle - s[k - 1].angle, 0.6 + 1e-12) << i << " " << k;
    }
  }
  EXPECT_GT(driver->statistics().impacts, 3);
}

TEST(PreciseStops, LimitsThatArePassedForMomentsAreMet) {
  // x'' = a sin(w t) from rest with x' = -a/w: x = -(a/w^2) sin(w t). The step is a second long, the limit is
  // above the first crest's reach by shares of it down to a millionth: passed for 3 ms or less at that.
  constexpr double kAmplitude = 40, kRate = 5, kCrest = kAmplitude / (kRate * kRate);
  for (const bool rope : {false, true}) {
    for (const double share : {0.5, 0.9, 0.99, 0.9999, 0.999999}) {
      Scene scene{.name = "moment", .gravity = {}};
      scene.bodies = {bead("slider", {0, 0})};
      scene.bodies[0].velocity = {kAmplitude / kRate, 0};
      scene.forces = {SinusoidalForce{
          .body = "slider", .amplitude = {kAmplitude, 0}, .angular_frequency = kRate, .phase = kPi}};
      const double limit = kCrest * share;
      if (rope) {
        scene.joints = {DistanceJoint{.name = "rope",
                                      .body_a = kFrame,
                                      .body_b = "slider",
                                      .anchor_a = {-20, 0},
                                      .length = 20 + limit,
                                      .range = Range{0, 20 + limit}}};
      } else {
        scene.joints = {
            PrismaticJoint{.name = "rail", .body_a = kFrame, .body_b = "slider", .limits = Range{-9, limit}}};
      }
      const auto driver = make_precise_driver(scene, {.tolerance = 1e-4, .max_dt = 1}, {});
      // Stopped there, x' = (a/w) (cos(w t) - cos(w t1)) from t1, asin(share)/w.
      const double met = std::asin(share) / kRate;
      const BodyState s = advance(*driver, 1, 1)[0];
      EXPECT_EQ(driver->statistics().impacts, 1) << rope << " " << share;
      const double t = 1 - met,
                   x = limit +
                       kAmplitude / kRate * ((std::sin(kRate) - share) / kRate - std::cos(kRate * met) * t);
      // A step's error of 1e-7 (a thousandth of the tolerance) moves t1 by itself over the speed there.
      EXPECT_NEAR(s.position.x, x, 4e-7 / std::cos(kRate * met)) << rope << " " << share;
    }
  }
}

TEST(PreciseStops, SavedAndRestoredRunsGoOnWithTheSameBits) {
  Scene scene{.name = "saved"};
  scene.bodies = {bead("slider", {0, 0}), {.name = "wheel", .position = {3, 0}, .inertia = 0.8}};
  scene.joints = {
      PrismaticJoint{
          .name = "rail", .body_a = kFrame, .body_b = "slider", .axis = {0, 1}, .limits = Range{-0.7, 2}},
      RevoluteJoint{
          .name = "axle", .body_a = kFrame, .body_b = "wheel", .anchor_a = {3, 0}, .motor = Motor{5, 6}}};
  Simulation one = compile(scene, Precise{});
  for (const int steps : {10, 30, 40}) {
    one.step(steps);
    const auto saved = one.save();
    Simulation other = compile(scene, Precise{});
    other.restore(saved);
    one.step(7), other.step(7);
    EXPECT_EQ(one.hash(), other.hash()) << steps;
  }
}

}  // namespace
}  // namespace plumb
