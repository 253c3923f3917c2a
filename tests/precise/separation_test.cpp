#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tests/precise/contact_scenes.h"
#include "tests/precise/truth.h"

namespace plumb {
namespace {

using truth::Real;

/// Steps until `event` has happened, at most `most` steps; returns the states then.
std::vector<BodyState> until(Driver& driver, std::size_t bodies, ContactEvent event, int most) {
  std::vector<BodyState> states(bodies);
  for (int i = 0; i < most && events(driver, event).count == 0; ++i) states = advance(driver, bodies, 1);
  EXPECT_EQ(events(driver, event).count, 1);
  return states;
}

TEST(PreciseSeparation, LadderLeavesTheWall) {
  // A uniform rod of length 2 against a smooth wall and floor; theta is its angle from the floor. As long as
  // it touches both, w^2 = 3/2 g (sin theta0 - sin theta) for L = 2; it leaves the wall at sin theta = 2/3
  // sin theta0.
  const double start = 1.2;
  Scene scene{.name = "ladder"};
  Body wall = block("wall", {-5, 50}, 10, 100, 0);
  wall.type = BodyType::Static;
  // The rod's line from the floor at the right up to the wall at the left: the box lies above it.
  Body ladder = rod_on_a_box("ladder", {std::cos(start), std::sin(start)}, -start, 0);
  scene.bodies = {ground(0), wall, ladder};
  const auto driver = make_precise_driver(scene, {}, {});
  until(*driver, 3, ContactEvent::Separation, 120);
  const double time = events(*driver, ContactEvent::Separation).last;
  // theta'' = -(3/4) g cos theta (L = 2), in long double.
  const auto fall = [](Real, const std::vector<Real>& y, std::vector<Real>& out) {
    out = {y[1], -0.75L * 9.81L * std::cos(y[0])};
  };
  const Real sine = std::sin(truth::integrate_twice(fall, {start, 0}, 0, time, 4000)[0]);
  EXPECT_NEAR(static_cast<double>(sine), 2.0 / 3 * std::sin(start), 1e-9);
  // Its centre goes on at v_x = sqrt(g L)/3 (sin theta0)^(3/2).
  const auto s = advance(*driver, 3, 2);
  EXPECT_NEAR(s[2].velocity.x, std::sqrt(9.81 * 2 * std::pow(std::sin(start), 3)) / 3, 1e-9);
}

/// A disc on a fixed cylinder of radius 1, `start` away from the top: the angle at which `event` happens
/// first. With `friction` it rolls until then, without it slides.
double angle_on_cylinder(double friction, double start, ContactEvent event) {
  Scene scene{.name = "cylinder"};
  Body cylinder = disc("cylinder", {0, 0}, {}, 1, friction);
  cylinder.type = BodyType::Static;
  scene.bodies = {cylinder,
                  disc("disc", {1.25 * std::sin(start), 1.25 * std::cos(start)}, {}, 0.25, friction)};
  const auto driver = make_precise_driver(scene, {}, {});
  until(*driver, 2, event, 600);
  const Real k = friction > 0 ? 0.5L : 0;  // of the inertia over m r^2, what takes part
  const auto run_down = [k](Real, const std::vector<Real>& y, std::vector<Real>& out) {
    out = {y[1], 9.81L / (1.25L * (1 + k)) * std::sin(y[0])};
  };
  return static_cast<double>(
      truth::integrate_twice(run_down, {start, 0}, 0, events(*driver, event).last, 4000)[0]);
}

TEST(PreciseSeparation, AParticleLeavesACylinder) {
  // N = m g cos - m v^2/R with v^2 = 2 g R (cos start - cos): zero at cos = 2/3 cos start, from the very top
  // at 48.1897 degrees.
  for (const double start : {0.01, 0.3}) {
    EXPECT_NEAR(angle_on_cylinder(0, start, ContactEvent::Separation), std::acos(2.0 / 3 * std::cos(start)),
                1e-9);
  }
  EXPECT_NEAR(std::acos(2.0 / 3) * 180 / kPi, 48.1897, 5e-5);
}

TEST(PreciseSeparation, ARollingDiscLosesItsGripOnACylinder) {
  // v^2 = 4/3 g R (cos start - cos), T = m g sin/3, N = m g (7 cos - 4 cos start)/3: it slips where T = mu N.
  // As mu grows that is where N = 0, from the very top at 55.1501 degrees, nearer by 1/(7 mu).
  for (const double start : {0.01, 0.3}) {
    for (const double mu : {0.5, 20.0, 1000.0}) {
      double low = start, high = 1.5;
      for (int i = 0; i < 100; ++i) {
        const double x = (low + high) / 2;
        (std::sin(x) < mu * (7 * std::cos(x) - 4 * std::cos(start)) ? low : high) = x;
      }
      EXPECT_NEAR(angle_on_cylinder(mu, start, ContactEvent::SlipStart), high, 1e-9) << mu;
      EXPECT_NEAR(high, std::acos(4.0 / 7 * std::cos(start)), 1 / (7 * mu) + 1e-9);
    }
  }
  EXPECT_NEAR(std::acos(4.0 / 7) * 180 / kPi, 55.1501, 5e-5);
}

TEST(PreciseSeparation, TopplingThresholds) {
  // Half-width b, half-height h: topples on a ramp of tan(theta) > b/h.
  const double b = 0.2, h = 0.5;
  for (const double shift : {-1e-6, 1e-6}) {
    Scene scene{.name = "topple", .gravity = gravity_on_ramp(std::atan(b / h) + shift)};
    scene.bodies = {ground(0.9), block("block", {0, h}, 2 * b, 2 * h, 0.9)};
    const double angle = run(scene, 150)[1].angle;
    if (shift < 0) {
      EXPECT_NEAR(angle, 0, 1e-13);
    } else {
      // (I + m (b^2 + h^2)) theta'' = m g sin(shift) |r| at first, and grows like cosh.
      const Real r2 = b * b + h * h, inertia = r2 / 3 + r2, w = std::sqrt(9.81L * std::sqrt(r2) / inertia);
      EXPECT_NEAR(angle / static_cast<double>(-1e-6L * (std::cosh(w * 2.5L) - 1)), 1, 1e-3);
    }
  }
}

TEST(PreciseSeparation, TopplingOnAPushedBase) {
  // A block on a plate that is pushed at acceleration a topples at a/g > b/h.
  const double b = 0.2, h = 0.5, g = 9.81, mass = 1000;
  for (const double shift : {-1e-6, 1e-6}) {
    Scene scene{.name = "push"};
    scene.bodies = {ground(0), block("plate", {0, 0.1}, 20, 0.2, 0.9),
                    block("block", {0, 0.2 + h}, 2 * b, 2 * h, 0.9)};
    scene.contact_rules.friction = Combine::Product;
    scene.bodies[1].mass = mass;
    scene.bodies[0].shapes[0].friction = 0;
    scene.bodies[1].shapes[0].friction = 0.95;
    scene.bodies[2].shapes[0].friction = 0.95;
    scene.forces = {PointForce{"plate", {(mass + 1) * g * (b / h + shift), 0}, {0, 0.1}}};
    const double angle = run(scene, 90)[2].angle;
    EXPECT_EQ(std::abs(angle) > 1e-6, shift > 0) << angle;
  }
}

TEST(PreciseSeparation, TheBlockThatOverhangsTooFarFalls) {
  // Blocks of length 1: the harmonic stack of three, with its top, middle or all of it a little too far out.
  for (const double shift : {-1e-6, 1e-6}) {
    for (const int which : {0, 1, 2}) {
      Scene scene{.name = "overhang"};
      Body table = block("table", {-0.5, -0.5}, 1, 1, 0.5);
      table.type = BodyType::Static;
      // From the top down, centres of mass of what lies above stand at the next edge: 1/2, 1/4, 1/6, each
      // safe by 1e-4 but one that is `shift` off its edge.
      const double safe = -1e-4;
      double edge = 0;  // of what the block lies on
      std::vector<Body> blocks;
      for (int i = 0; i < 3; ++i) {
        const double out = 0.5 / (3 - i) + (i == which ? shift : safe);
        edge += out;
        blocks.push_back(block("block" + std::to_string(i), {edge - 0.5, 0.125 + 0.25 * i}, 1, 0.25, 0.5));
      }
      // The blocks on block i are balanced over its edge when the others are exact; correct for the safe
      // ones.
      scene.bodies = {table, blocks[0], blocks[1], blocks[2]};
      double support = 0;
      bool falls = false;
      for (int i = 0; i < 3; ++i) {
        double centre = 0;
        for (int j = i; j < 3; ++j) centre += blocks[j].position.x / (3 - i);
        falls = falls || centre > support;
        support = blocks[i].position.x + 0.5;
      }
      const auto driver = make_precise_driver(scene, {}, {});
      const auto s = advance(*driver, 4, 90);
      double turned = 0;
      int first = 3;
      for (int i = 0; i < 3; ++i) {
        turned = std::max(turned, std::abs(s[i + 1].angle));
        if (std::abs(s[i + 1].angle) > 1e-7) first = std::min(first, i);
      }
      EXPECT_EQ(turned > 1e-7, falls) << which << " " << shift << " " << turned;
      if (falls) {
        EXPECT_EQ(first, which);
      }
    }
  }
}

TEST(PreciseImpactOfBoxes, RodFallsOnItsEnd) {
  // J = (1 + e) m v/(1 + 3 cos^2 theta), off the centre by cos theta for L = 2.
  for (const double e : {0.25, 0.5, 1.0}) {
    for (const double angle : {0.3, 0.6, 1.2}) {
      Scene scene{.name = "rod"};
      scene.bodies = {ground(0, e), rod_on_a_box("rod", {0, 2}, angle, 0, e)};
      const double v = std::sqrt(2 * 9.81 * (2 - std::sin(angle)));
      const auto driver = make_precise_driver(scene, {}, {});
      const auto s = advance(*driver, 2, static_cast<int>(std::ceil(60 * v / 9.81)));
      const double c = std::cos(angle), impulse = (1 + e) * v / (1 + 3 * c * c);
      EXPECT_NEAR(s[1].angular_velocity, -impulse * c * 3, 4e-12) << e << " " << angle;
    }
  }
}

TEST(PreciseImpactOfBoxes, ABoxThatFallsFlatStaysLevel) {
  for (const Simultaneous rule : {Simultaneous::Sequence, Simultaneous::Together}) {
    Scene scene{.name = "flat"};
    scene.contact_rules.simultaneous = rule;
    scene.bodies = {ground(0.5, 0.7), block("box", {0.3, 1.25}, 1, 0.5, 0.5, 0.7)};
    const auto driver = make_precise_driver(scene, {}, {});
    const double v = std::sqrt(2 * 9.81), t = v / 9.81;
    const auto s = advance(*driver, 2, 30);
    EXPECT_NEAR(s[1].velocity.y, 0.7 * v - 9.81 * (0.5 - t), 1e-13);
    EXPECT_NEAR(s[1].angular_velocity, 0, 1e-14);
    EXPECT_NEAR(s[1].velocity.x, 0, 1e-14);
  }
}

TEST(PreciseImpactOfBoxes, NothingIsMissedAtAnySpeedOrSpin) {
  // A stick that spins at 2000 rad/s flies at 300 m/s against a wall of a tenth of a millimetre: it comes
  // back, with its energy.
  Scene scene{.name = "thin", .gravity = {0, 0}};
  Body wall = block("wall", {5, 0}, 1e-4, 10, 0, 1);
  wall.type = BodyType::Static;
  scene.bodies = {wall, block("stick", {0, 0}, 1, 0.01, 0, 1)};
  scene.bodies[1].velocity = {300, 0};
  for (const double spin : {0.0, 20.0, 2000.0, -31234.5}) {
    scene.bodies[1].angular_velocity = spin;
    const double inertia = inertia_of(scene.bodies[1]);
    const auto s = run(scene, 3);
    EXPECT_LT(s[1].position.x, 4.6) << spin;
    EXPECT_LT(s[1].velocity.x, 0) << spin;
    const double before = 90000 + inertia * spin * spin;
    EXPECT_NEAR(
        (length_squared(s[1].velocity) + inertia * s[1].angular_velocity * s[1].angular_velocity) / before, 1,
        1e-13);
  }
}

TEST(PreciseImpactOfBoxes, GalperinsBilliardCountsThePi) {
  const int counts[] = {3, 31, 314, 3141, 31415};
  for (int n = 0; n < 5; ++n) {
    Scene scene{.name = "galperin", .gravity = {0, 0}};
    Body wall = block("wall", {-0.5, 0}, 1, 4, 0, 1);
    wall.type = BodyType::Static;
    scene.bodies = {wall, block("light", {1.5, 0}, 1, 1, 0, 1), block("heavy", {3.5, 0}, 1, 1, 0, 1)};
    scene.bodies[2].mass = std::pow(100, n);
    scene.bodies[2].velocity = {-1, 0};
    const auto driver = make_precise_driver(scene, {.max_dt = 1}, {});
    advance(*driver, 3, 100);
    EXPECT_EQ(driver->statistics().impacts, counts[n]) << n;
  }
}

TEST(PreciseImpactOfBoxes, GalileanCannonAndCradle) {
  // The light ball leaves at (3 M - m)/(M + m) v.
  Scene cannon{.name = "cannon", .gravity = {0, 0}};
  Body wall = block("wall", {-1.5, 0}, 1, 4, 0, 1);
  wall.type = BodyType::Static;
  cannon.bodies = {wall, ball("heavy", {0, 0}, {-1, 0}, 9), ball("light", {1.001, 0}, {-1, 0}, 1)};
  EXPECT_NEAR(run(cannon, 120)[2].velocity.x, 2.6, 1e-14);
  Scene cradle{.name = "cradle", .gravity = {0, 0}};
  for (int i = 0; i < 5; ++i)
    cradle.bodies.push_back(block("b" + std::to_string(i), {1.01 * i, 0}, 1, 0.4, 0, 1));
  cradle.bodies[0].velocity = {2, 0};
  const auto s = run(cradle, 60);
  for (int i = 0; i < 5; ++i) EXPECT_NEAR(s[i].velocity.x, i == 4 ? 2 : 0, 1e-14);
}

TEST(PreciseImpactOfBoxes, BlockOnAFreeWedge) {
  // The wedge backs away at m g sin cos/(M + m sin^2).
  const double angle = 0.5, c = std::cos(angle), si = std::sin(angle);
  Scene scene{.name = "wedge"};
  Body wedge = block("wedge", {0, 0}, 4, 1, 0);
  wedge.angle = -angle;
  wedge.mass = 3;
  wedge.fixed_rotation = true;
  Body rail = ground(0);
  rail.position.y = -2 * si - 0.5 * c - 0.5;  // under the wedge's lowest corner
  Body sliding = block("block", {-0.5 * c + 0.75 * si, 0.5 * si + 0.75 * c}, 0.5, 0.5, 0);
  sliding.angle = -angle;
  scene.bodies = {rail, wedge, sliding};
  const auto s = run(scene, 12);
  EXPECT_NEAR(s[1].velocity.x / 0.2, -9.81 * si * c / (3 + si * si), 1e-12);
  EXPECT_NEAR(s[2].angle, -angle, 1e-13);
}

TEST(PreciseImpactOfBoxes, TogetherPassesABlowOnAtOnce) {
  // Three touching equal discs, the first comes in with v, e = 1. Together: u' >= -u at the closing contact,
  // u' >= 0 at the touching one: v (-1/3, 2/3, 2/3). As a sequence: (0, 0, v).
  Scene scene{.name = "row", .gravity = {0, 0}};
  scene.bodies = {ball("a", {0, 0}, {3, 0}), ball("b", {2, 0}), ball("c", {3, 0})};
  scene.contact_rules.simultaneous = Simultaneous::Together;
  const auto together = run(scene, 60);
  EXPECT_NEAR(together[0].velocity.x, -1, 1e-13);
  EXPECT_NEAR(together[1].velocity.x, 2, 1e-13);
  EXPECT_NEAR(together[2].velocity.x, 2, 1e-13);
  scene.contact_rules.simultaneous = Simultaneous::Sequence;
  EXPECT_NEAR(run(scene, 60)[2].velocity.x, 3, 1e-13);
}

}  // namespace
}  // namespace plumb
