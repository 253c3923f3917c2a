#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "engine/scene/error.h"
#include "engine/simulation/simulation.h"
#include "tests/precise/contact_scenes.h"

// Friction with a static and a kinetic coefficient, against closed forms.
namespace plumb {
namespace {

constexpr double kGravity = 9.81;

/// A block on a ramp that goes down to the right, with the kinetic coefficient `share` times the static one.
Scene block_on_ramp(double angle, double friction, double share, double velocity = 0) {
  Scene scene{.name = "ramp", .gravity = gravity_on_ramp(angle)};
  scene.contact_rules.friction_while_sliding = share;
  scene.bodies = {ground(friction), block("block", {0, 0.25}, 2, 0.5, friction)};
  scene.bodies[1].velocity.x = velocity;
  return scene;
}

TEST(KineticFriction, ABlockSticksBelowTheStaticLineAndSlidesByTheKineticCoefficientAboveIt) {
  for (const double angle : {0.1, 0.4, 0.8}) {
    const double line = std::tan(angle);
    for (const double share : {0.0, 0.3, 0.8, 1.0}) {
      const auto stuck = run(block_on_ramp(angle, line * (1 + 1e-9), share), 60);
      EXPECT_NEAR(stuck[1].velocity.x, 0, 1e-13) << angle << " " << share;
      const double mu = line * (1 - 1e-6), a = kGravity * (std::sin(angle) - share * mu * std::cos(angle));
      const auto sliding = run(block_on_ramp(angle, mu, share), 60);
      EXPECT_NEAR(sliding[1].velocity.x, a, 1e-11) << angle << " " << share;
      EXPECT_NEAR(sliding[1].position.x, a / 2, 1e-11) << angle << " " << share;
    }
  }
}

TEST(KineticFriction, ABlockThrownUphillStopsAndStaysIfStaticFrictionHolds) {
  const double angle = 0.4, v = 3, share = 0.5;
  for (const double mu : {1.5 * std::tan(angle), 0.9 * std::tan(angle)}) {
    const double up = kGravity * (std::sin(angle) + share * mu * std::cos(angle));
    const double down = kGravity * (std::sin(angle) - share * mu * std::cos(angle));
    const double stops = v / up, after = 1 - stops;
    ASSERT_GT(after, 0);
    ASSERT_GT(down, 0);  // kinetic friction alone would not hold it
    const bool holds = mu > std::tan(angle);
    const auto s = run(block_on_ramp(angle, mu, share, -v), 60);
    EXPECT_NEAR(s[1].velocity.x, holds ? 0 : down * after, 1e-10) << mu;
    EXPECT_NEAR(s[1].position.x, -v * v / (2 * up) + (holds ? 0 : down * after * after / 2), 1e-10) << mu;
  }
}

TEST(KineticFriction, ADiscRollsUpToTheStaticLineAndSpinsByTheKineticCoefficientBeyond) {
  const double angle = 0.5, line = std::tan(angle) / 3, share = 0.6;
  for (const double mu : {line * (1 + 1e-6), line * (1 - 1e-6)}) {
    Scene scene = block_on_ramp(angle, mu, share);
    scene.bodies[1] = disc("disc", {0, 0.5}, {}, 0.5, mu);
    const auto s = run(scene, 60);
    const double slides = kGravity * (std::sin(angle) - share * mu * std::cos(angle));
    const double rolls = 2.0 / 3 * kGravity * std::sin(angle);
    const double spin = 2 * share * mu * kGravity * std::cos(angle) / 0.5;
    EXPECT_NEAR(s[1].velocity.x, mu > line ? rolls : slides, 1e-10) << mu;
    EXPECT_NEAR(s[1].angular_velocity, mu > line ? -rolls / 0.5 : -spin, 1e-10) << mu;
  }
}

// F sin(w t) overcomes static friction at sin(w t1) = mu m g / F, and drives against the kinetic one from
// then.
TEST(KineticFriction, AGrowingForceBreaksABlockLooseAtTheStaticForce) {
  const double mu = 0.4, share = 0.5, force = 6, w = 1, m = 1;
  Scene scene = block_on_ramp(0, mu, share);
  scene.forces = {SinusoidalForce{.body = "block", .amplitude = {force, 0}, .angular_frequency = w}};
  const double t1 = std::asin(mu * m * kGravity / force) / w, t = 1.5;
  ASSERT_LT(t1, t);
  const double v = force / (m * w) * (std::cos(w * t1) - std::cos(w * t)) - share * mu * kGravity * (t - t1);
  const auto driver = make_precise_driver(scene, {.tolerance = 1e-11}, {});
  const auto s = advance(*driver, 2, 90);
  EXPECT_NEAR(s[1].velocity.x, v, 1e-8);
  EXPECT_NEAR(events(*driver, ContactEvent::SlipStart).last, t1, 1e-8);
}

TEST(KineticFriction, WithoutKineticFrictionABlockGlidesButStopsWhereItComesToRest) {
  EXPECT_NEAR(run(block_on_ramp(0, 0.8, 0, 2), 60)[1].velocity.x, 2, 1e-13);
  const double angle = 0.3, v = 1;  // uphill until v / (g sin(angle)), then static friction holds it
  const auto s = run(block_on_ramp(angle, 0.8, 0, -v), 60);
  EXPECT_NEAR(s[1].position.x, -v * v / (2 * kGravity * std::sin(angle)), 1e-11);
  EXPECT_NEAR(s[1].velocity.x, 0, 1e-12);
}

TEST(KineticFriction, NeverGainsEnergy) {
  for (const double share : {0.0, 0.4, 0.9}) {
    for (const double mu : {0.2, 0.6, 1.2}) {
      // Two blocks on each other: the lower one is pushed along a floor under the upper one.
      Scene scene{.name = "pair"};
      scene.contact_rules.friction_while_sliding = share;
      scene.bodies = {ground(mu), block("lower", {0, 0.25}, 3, 0.5, mu),
                      block("upper", {0, 0.75}, 1, 0.5, mu)};
      scene.bodies[1].velocity.x = 2;
      const auto driver = make_precise_driver(scene, {}, {});
      double before = 2;
      for (int step = 0; step < 90; ++step) {
        const auto s = advance(*driver, 3, 1);
        double energy = 0;
        for (const std::size_t body : {1, 2}) {
          energy += length_squared(s[body].velocity) / 2 + kGravity * s[body].position.y -
                    kGravity * (body == 1 ? 0.25 : 0.75);
        }
        EXPECT_LE(energy, before + 1e-12) << share << " " << mu << " " << step;
        before = energy;
      }
    }
  }
}

TEST(KineticFriction, AnEngineWithoutItNamesTheField) {
  const Scene scene = block_on_ramp(0.1, 0.5, 0.5);
  EXPECT_NE(unsupported(scene, Realtime{}).find("friction_while_sliding"), std::string::npos);
  EXPECT_EQ(unsupported(scene, Precise{}), "");
}

}  // namespace
}  // namespace plumb
