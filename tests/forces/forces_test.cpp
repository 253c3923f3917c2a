#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "engine/forces/laws.h"
#include "engine/forces/potential.h"
#include "engine/math/trigonometry.h"

namespace plumb {
namespace {

constexpr double kForever = std::numeric_limits<double>::infinity();

TEST(ActiveShare, ExactInsideOutsideAndAcrossTheEdges) {
  EXPECT_EQ(active_fraction(0, kForever, 0, 0.1), 1);
  EXPECT_EQ(active_fraction(1, 2, 1, 3), 1);
  EXPECT_EQ(active_fraction(1, 2, 0, 1), 0);
  EXPECT_EQ(active_fraction(1, 2, 3, 4), 0);
  EXPECT_EQ(active_fraction(1, 2, 0, 4), 0.5);
  EXPECT_EQ(active_fraction(1, 2, 0.5, 1.5), 0.5);
  EXPECT_EQ(active_fraction(1, 2, 2.75, 3.75), 0.25);
  EXPECT_EQ(active_fraction(1, 0, 0, 4), 0);
}

TEST(ActiveShare, AtAnInstant) {
  EXPECT_EQ(active_fraction(1, 2, 0.5, 0.5), 0);
  EXPECT_EQ(active_fraction(1, 2, 1, 1), 1);
  EXPECT_EQ(active_fraction(1, 2, 2.5, 2.5), 1);
  EXPECT_EQ(active_fraction(1, 2, 3, 3), 0);
}

TEST(ActiveShare, ImpulseOverAnyStepsIsForceTimesDuration) {
  const double start = 0.3, duration = 0.77, dt = 1.0 / 60;
  double impulse = 0;
  for (int i = 0; i < 100; ++i) impulse += active_fraction(start, duration, i * dt, (i + 1) * dt) * dt;
  EXPECT_NEAR(impulse, duration, 1e-14);
}

const BodyState kState{{1, 2}, 0.7, {3, -4}, 5};

/// A body "b" in `kState`, and a body "c" in `kOther`, under one law.
const BodyState kOther{{4, -2}, -0.3, {-1, 0.5}, 2};

struct Pair {
  Wrench<double> b, c;
};

Scene scene_with(const ForceLaw& law) {
  Scene scene;
  scene.bodies = {{.name = "b", .mass = 3}, {.name = "c", .mass = 7}};
  scene.forces = {law};
  return scene;
}

Pair evaluate(const ForceLaw& law, double t0, double t1, const BodyState& b = kState,
              const BodyState& c = kOther) {
  const Forces forces(scene_with(law));
  std::vector<Pose<double>> poses;
  std::vector<Twist<double>> twists;
  for (const BodyState& state : {b, c}) {
    poses.push_back({state.position, rotation_of(state.angle)});
    twists.push_back({state.velocity, state.angular_velocity});
  }
  std::vector<Wrench<double>> out(2);
  forces.add(t0, t1, poses.data(), twists.data(), out.data());
  return {out[0], out[1]};
}

TEST(Law, LinearDragOpposesTheVelocity) {
  const Wrench<double> w = evaluate(LinearDrag{"b", 0.5}, 0, 1).b;
  EXPECT_EQ(w.force, (Vec2d{-1.5, 2}));
  EXPECT_EQ(w.torque, 0);
}

TEST(Law, QuadraticDragGrowsWithTheSpeed) {
  const Wrench<double> w = evaluate(QuadraticDrag{"b", 0.5}, 0, 1).b;  // |v| = 5
  EXPECT_EQ(w.force, (Vec2d{-7.5, 10}));
  EXPECT_EQ(w.torque, 0);
}

TEST(Law, WorldForceTurnsWithTheArmOnly) {
  const Wrench<double> w = evaluate(PointForce{"b", {2, 3}, {0.5, -1}}, 0, 1).b;
  EXPECT_EQ(w.force, (Vec2d{2, 3}));
  const Rotation<double> q = rotation_of(0.7);
  const double rx = q.c * 0.5 + q.s, ry = q.s * 0.5 - q.c;
  EXPECT_NEAR(w.torque, rx * 3 - ry * 2, 1e-15);
}

TEST(Law, BodyForceKeepsItsTorque) {
  const Wrench<double> w = evaluate(PointForce{"b", {2, 3}, {0.5, -1}, Frame::Body}, 0, 1).b;
  const Rotation<double> q = rotation_of(0.7);
  EXPECT_NEAR(w.force.x, q.c * 2 - q.s * 3, 1e-15);
  EXPECT_NEAR(w.force.y, q.s * 2 + q.c * 3, 1e-15);
  EXPECT_NEAR(w.torque, 0.5 * 3 + 1 * 2, 1e-14);
}

TEST(Law, SwitchedLawsAreAveraged) {
  EXPECT_EQ(evaluate(Torque{"b", 4, 1, 2}, 0, 4).b.torque, 2);
  EXPECT_EQ(evaluate(PointForce{"b", {8, 0}, {}, Frame::World, 1, 1}, 0, 4).b.force.x, 2);
}

TEST(Law, SpringPullsAlongItsLine) {
  // Ends at (1, 2) and (4, -2), 5 m apart along (0.6, -0.8); they part at (-4, 4.5).(0.6, -0.8) = -6 m/s.
  const SpringForce spring{"b", "c", {}, {}, 2, 10, 0.5};
  const auto [b, c] = evaluate(spring, 0, 1);
  const double tension = 10 * (5 - 2) + 0.5 * -6;
  EXPECT_NEAR(b.force.x, tension * 0.6, 1e-13);
  EXPECT_NEAR(b.force.y, tension * -0.8, 1e-13);
  EXPECT_EQ(b.torque, 0);
  EXPECT_EQ(c.force, -b.force);
}

TEST(Law, SpringOfNoLengthPullsNowhere) {
  const auto [b, c] = evaluate(SpringForce{"b", "c", {}, {}, 2, 10, 1}, 0, 1, kState, kState);
  EXPECT_EQ(b.force, Vec2d{});
  EXPECT_EQ(c.torque, 0);
}

TEST(Law, SpringToTheWorldPullsOneBody) {
  const auto [b, c] = evaluate(SpringForce{"world", "b", {1, 6}, {}, 1, 10}, 0, 1);
  EXPECT_NEAR(b.force.x, 0, 1e-14);
  EXPECT_NEAR(b.force.y, 30, 1e-13);
  EXPECT_EQ(c.force, Vec2d{});
}

TEST(Law, AttractionIsMuMassOverDistanceToThePower) {
  for (int n = -2; n <= 4; ++n) {
    const auto [b, c] = evaluate(AttractionForce{"b", "world", {4, -2}, 1.5, n}, 0, 1);
    const double size = 1.5 * 3 / std::pow(5.0, n);
    EXPECT_NEAR(b.force.x, size * 0.6, 1e-14 * size) << n;
    EXPECT_NEAR(b.force.y, size * -0.8, 1e-14 * size) << n;
    EXPECT_EQ(c.force, Vec2d{});
  }
}

/// Newton's third law with its torque: forces between two bodies change neither momentum nor angular
/// momentum.
TEST(Law, BetweenTwoBodiesActionIsReaction) {
  const ForceLaw laws[] = {SpringForce{"b", "c", {0.3, 0.1}, {-0.2, 0.7}, 2, 10, 0.5},
                           AttractionForce{"b", "c", {0.4, -0.6}, 2, 2}};
  for (const ForceLaw& law : laws) {
    const auto [b, c] = evaluate(law, 0, 1);
    EXPECT_GT(std::abs(b.force.x), 0.1);
    EXPECT_NEAR(b.force.x + c.force.x, 0, 1e-14);
    EXPECT_NEAR(b.force.y + c.force.y, 0, 1e-14);
    EXPECT_NEAR(b.torque + c.torque + cross(kState.position, b.force) + cross(kOther.position, c.force), 0,
                1e-12);
  }
}

TEST(Law, SinusoidalForceHasItsValueAtAnInstantAndItsMeanOverASpan) {
  const SinusoidalForce law{"b", {2, -4}, {0.5, -1}, 3, 0.4};
  const double now = std::sin(3 * 0.7 + 0.4);
  const Wrench<double> at = evaluate(law, 0.7, 0.7).b;
  EXPECT_NEAR(at.force.x, 2 * now, 1e-15);
  EXPECT_NEAR(at.force.y, -4 * now, 1e-15);
  const Rotation<double> q = rotation_of(0.7);
  EXPECT_NEAR(at.torque, cross(q * Vec2d{0.5, -1}, Vec2d{2 * now, -4 * now}), 1e-14);
  // The integral of sin(3 t + 0.4) is -cos(3 t + 0.4) / 3.
  const double mean = (std::cos(3 * 0.2 + 0.4) - std::cos(3 * 1.9 + 0.4)) / 3 / 1.7;
  EXPECT_NEAR(evaluate(law, 0.2, 1.9).b.force.x, 2 * mean, 1e-15);
}

/// The forces are the slopes of the energy, by central differences of 1e-5 (error 1e-10 times third
/// derivatives, of up to 30 here).
TEST(PotentialEnergy, ItsSlopeIsTheForce) {
  std::vector<ForceLaw> laws = {SpringForce{"b", "c", {0.3, 0.1}, {-0.2, 0.7}, 2, 10},
                                SpringForce{"world", "c", {0.3, 0.1}, {-0.2, 0.7}, 2, 10}};
  for (int n = -1; n <= 4; ++n) laws.push_back(AttractionForce{"b", "c", {0.4, -0.6}, 2, n});
  for (const ForceLaw& law : laws) {
    const Scene scene = scene_with(law);
    const auto [b, c] = evaluate(law, 0, 1, {kState.position, kState.angle}, {kOther.position, kOther.angle});
    const auto slope = [&](std::size_t body, auto move) {
      constexpr double kStep = 1e-5;
      std::vector<BodyState> ahead = {kState, kOther}, behind = ahead;
      move(ahead[body], kStep), move(behind[body], -kStep);
      return (potential_energy(scene, ahead) - potential_energy(scene, behind)) / (2 * kStep);
    };
    const auto along_x = [](BodyState& s, double by) { s.position.x += by; };
    const auto along_y = [](BodyState& s, double by) { s.position.y += by; };
    const auto turn = [](BodyState& s, double by) { s.angle += by; };
    const Wrench<double> wrenches[] = {b, c};
    for (const std::size_t body : {0, 1}) {
      EXPECT_NEAR(slope(body, along_x), -wrenches[body].force.x, 3e-9);
      EXPECT_NEAR(slope(body, along_y), -wrenches[body].force.y, 3e-9);
      EXPECT_NEAR(slope(body, turn), -wrenches[body].torque, 3e-9);
    }
  }
}

Scene scene_of_all_laws() {
  Scene scene;
  scene.bodies = {{.name = "p"}, {.name = "free"}, {.name = "q"}};
  scene.forces = {LinearDrag{"q", 0.25},
                  QuadraticDrag{"p", 0.125},
                  PointForce{"q", {1, 2}, {3, 4}},
                  Torque{"p", 7, 0.5, 1},
                  Torque{"q", -1},
                  SpringForce{"world", "q", {5, 5}, {1, 0}, 1, 2},
                  AttractionForce{"p", "world", {9, 9}, 30, 2},
                  SinusoidalForce{"q", {1, 1}, {0, 1}, 2, 1}};
  return scene;
}

TEST(Forces, AddsEveryLawToItsBody) {
  const Scene scene = scene_of_all_laws();
  const Forces forces(scene);
  EXPECT_FALSE(forces.empty());
  EXPECT_TRUE(forces.acts_on(0));
  EXPECT_FALSE(forces.acts_on(1));
  EXPECT_TRUE(forces.acts_on(2));
  const std::vector<Pose<double>> poses(3, {{1, 2}, rotation_of(0.7)});
  const std::vector<Twist<double>> twists(3, {{3, -4}, 5});
  std::vector<Wrench<double>> sum(3, {{100, 200}, 300});
  forces.add(0, 1, poses.data(), twists.data(), sum.data());
  std::vector<Wrench<double>> expected(3, {{100, 200}, 300});
  for (const ForceLaw& law : scene.forces) {
    Scene one = scene;
    one.forces = {law};
    Forces(one).add(0, 1, poses.data(), twists.data(), expected.data());
  }
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(sum[i].force.x, expected[i].force.x, 1e-12);
    EXPECT_NEAR(sum[i].force.y, expected[i].force.y, 1e-12);
    EXPECT_NEAR(sum[i].torque, expected[i].torque, 1e-12);
  }
  EXPECT_EQ(sum[1].torque, 300);
}

TEST(Forces, AtAnInstantOfASpanOnlySwitchesAreAveraged) {
  Scene scene;
  scene.bodies = {{.name = "p"}};
  scene.forces = {PointForce{"p", {8, 0}, {}, Frame::World, 1, 1}, SinusoidalForce{"p", {0, 2}, {}, 3, 0}};
  const Pose<double> pose{};
  const Twist<double> twist{};
  Wrench<double> sum{};
  Forces(scene).add_at(0.5, 0, 4, &pose, &twist, &sum);
  EXPECT_EQ(sum.force.x, 2);
  EXPECT_NEAR(sum.force.y, 2 * std::sin(1.5), 1e-15);
}

TEST(Forces, Empty) {
  Scene scene;
  scene.bodies = {{.name = "p"}};
  EXPECT_TRUE(Forces(scene).empty());
}

}  // namespace
}  // namespace plumb
