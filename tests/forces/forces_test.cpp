#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "engine/forces/evaluate.h"
#include "engine/forces/laws.h"
#include "engine/math/trigonometry.h"

namespace plumb {
namespace {

constexpr double kForever = std::numeric_limits<double>::infinity();

TEST(ActiveShare, ExactInsideOutsideAndAcrossTheEdges) {
  EXPECT_EQ(active_share(0, kForever, 0, 0.1), 1);
  EXPECT_EQ(active_share(1, 2, 1, 3), 1);
  EXPECT_EQ(active_share(1, 2, 0, 1), 0);
  EXPECT_EQ(active_share(1, 2, 3, 4), 0);
  EXPECT_EQ(active_share(1, 2, 0, 4), 0.5);
  EXPECT_EQ(active_share(1, 2, 0.5, 1.5), 0.5);
  EXPECT_EQ(active_share(1, 2, 2.75, 3.75), 0.25);
  EXPECT_EQ(active_share(1, 0, 0, 4), 0);
}

TEST(ActiveShare, AtAnInstant) {
  EXPECT_EQ(active_share(1, 2, 0.5, 0.5), 0);
  EXPECT_EQ(active_share(1, 2, 1, 1), 1);
  EXPECT_EQ(active_share(1, 2, 2.5, 2.5), 1);
  EXPECT_EQ(active_share(1, 2, 3, 3), 0);
}

TEST(ActiveShare, ImpulseOverAnyStepsIsForceTimesDuration) {
  const double start = 0.3, duration = 0.77, dt = 1.0 / 60;
  double impulse = 0;
  for (int i = 0; i < 100; ++i) impulse += active_share(start, duration, i * dt, (i + 1) * dt) * dt;
  EXPECT_NEAR(impulse, duration, 1e-14);
}

const BodyState kState{{1, 2}, 0.7, {3, -4}, 5};

TEST(Evaluate, LinearDragOpposesTheVelocity) {
  const Wrench<double> w = evaluate(LinearDrag{"b", 0.5}, kState, 0, 1);
  EXPECT_EQ(w.force, (Vec2d{-1.5, 2}));
  EXPECT_EQ(w.torque, 0);
}

TEST(Evaluate, QuadraticDragGrowsWithTheSpeed) {
  const Wrench<double> w = evaluate(QuadraticDrag{"b", 0.5}, kState, 0, 1);  // |v| = 5
  EXPECT_EQ(w.force, (Vec2d{-7.5, 10}));
  EXPECT_EQ(w.torque, 0);
}

TEST(Evaluate, WorldForceTurnsWithTheArmOnly) {
  const Wrench<double> w = evaluate(PointForce{"b", {2, 3}, {0.5, -1}}, kState, 0, 1);
  EXPECT_EQ(w.force, (Vec2d{2, 3}));
  const Rotation<double> q = rotation_of(0.7);
  const double rx = q.c * 0.5 + q.s, ry = q.s * 0.5 - q.c;
  EXPECT_NEAR(w.torque, rx * 3 - ry * 2, 1e-15);
}

TEST(Evaluate, BodyForceKeepsItsTorque) {
  const Wrench<double> w = evaluate(PointForce{"b", {2, 3}, {0.5, -1}, Frame::Body}, kState, 0, 1);
  const Rotation<double> q = rotation_of(0.7);
  EXPECT_NEAR(w.force.x, q.c * 2 - q.s * 3, 1e-15);
  EXPECT_NEAR(w.force.y, q.s * 2 + q.c * 3, 1e-15);
  EXPECT_NEAR(w.torque, 0.5 * 3 + 1 * 2, 1e-14);
}

TEST(Evaluate, SwitchedLawsAreAveraged) {
  EXPECT_EQ(evaluate(Torque{"b", 4, 1, 2}, kState, 0, 4).torque, 2);
  const Wrench<double> w = evaluate(PointForce{"b", {8, 0}, {}, Frame::World, 1, 1}, kState, 0, 4);
  EXPECT_EQ(w.force.x, 2);
}

Scene scene_of_all_laws() {
  Scene scene;
  scene.bodies = {{.name = "p"}, {.name = "free"}, {.name = "q"}};
  scene.forces = {LinearDrag{"q", 0.25}, QuadraticDrag{"p", 0.125}, PointForce{"q", {1, 2}, {3, 4}},
                  Torque{"p", 7, 0.5, 1}, Torque{"q", -1}};
  return scene;
}

template <class Real>
void check_sum(Real tolerance) {
  const Scene scene = scene_of_all_laws();
  const Forces<Real> forces(scene);
  EXPECT_FALSE(forces.empty());
  EXPECT_TRUE(forces.acts_on(0));
  EXPECT_FALSE(forces.acts_on(1));
  EXPECT_TRUE(forces.acts_on(2));
  const std::vector<Pose<Real>> poses(3, {{1, 2}, rotation_of(Real(0.7))});
  const std::vector<Twist<Real>> twists(3, {{3, -4}, 5});
  std::vector<Wrench<Real>> sum(3, {{100, 200}, 300});
  forces.add(0, 1, poses.data(), twists.data(), sum.data());
  std::vector<Wrench<double>> expected(3, {{100, 200}, 300});
  for (const ForceLaw& law : scene.forces) {
    const std::string body = std::visit([](const auto& l) { return l.body; }, law);
    expected[body == "p" ? 0 : 2] += evaluate(law, kState, 0, 1);
  }
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(sum[i].force.x, expected[i].force.x, tolerance);
    EXPECT_NEAR(sum[i].force.y, expected[i].force.y, tolerance);
    EXPECT_NEAR(sum[i].torque, expected[i].torque, tolerance);
  }
}

TEST(Forces, AddsEveryLawToItsBody) {
  check_sum<double>(1e-12);
  check_sum<float>(1e-4f);
}

TEST(Forces, Empty) {
  Scene scene;
  scene.bodies = {{.name = "p"}};
  EXPECT_TRUE(Forces<double>(scene).empty());
}

}  // namespace
}  // namespace plumb
