#include <gtest/gtest.h>

#include <cmath>

#include "tests/simulation/scenes.h"

namespace plumb {
namespace {

using namespace plumb::testing;

Vec2d tip(const Simulation& world) {
  const BodyState last = world.state(world.body_count() - 1);
  return last.position + rotation_of(last.angle) * Vec2d{0.5, 0};
}

// One rod released from the horizontal, for 1 s: energy m g L/2 = 4.905 J.
TEST(Joints, RodKeepsItsEnergyAndItsHinge) {
  const Scene scene = rods(1);
  Simulation world = compile(scene);
  double drift = 0, gap = 0;
  for (int i = 0; i < 60; ++i) {
    world.step();
    drift = std::fmax(drift, std::abs(energy(scene, world)));
    gap = std::fmax(gap, hinge_gap(world));
  }
  EXPECT_LT(drift / (kGravity / 2), 1e-4);
  EXPECT_LT(gap, 1e-11);  // articulated bodies close their hinges to this
}

// Published: chains of uniform rods, 1 m and 1 kg, laid along +x and released; the tip at t = 1 s.
TEST(Joints, ChainsConvergeToThePublishedTipWithSecondOrder) {
  const struct {
    int rods;
    Vec2d tip;
    double at_four_substeps;  // m
  } table[] = {{2, {-1.66211513581613, -1.04146663719322}, 1e-4},
               {5, {0.533569475142432, -4.91970960757084}, 1e-3}};
  for (const auto& row : table) {
    double error[3];
    const int substeps[] = {4, 8, 16};
    for (int k = 0; k < 3; ++k) {
      Simulation world = compile(rods(row.rods), Realtime{.substeps = substeps[k]});
      world.step(60);
      error[k] = std::sqrt(length_squared(tip(world) - row.tip));
    }
    EXPECT_LT(error[0], row.at_four_substeps);
    EXPECT_NEAR(std::log2(error[0] / error[1]), 2, 0.05) << row.rods;
    EXPECT_NEAR(std::log2(error[1] / error[2]), 2, 0.05) << row.rods;
  }
}

TEST(Joints, LongChainsDoNotStretch) {
  for (const int count : {20, 100}) {
    Simulation world = compile(rods(count));
    double gap = 0;
    for (int i = 0; i < 60; ++i) world.step(), gap = std::fmax(gap, hinge_gap(world));
    EXPECT_LT(gap, 1e-11) << count;
  }
}

TEST(Joints, FloatHoldsToItsRounding) {
  Simulation world = compile(rods(5), Realtime{.precision = Precision::Float});
  double gap = 0;
  for (int i = 0; i < 60; ++i) world.step(), gap = std::fmax(gap, hinge_gap(world));
  EXPECT_LT(gap, 5e-6);
}

// Iterated soft hinges give: the gap falls with the substep's square.
TEST(Joints, IterativeHingesStretchLessWithSmallerSubsteps) {
  double gap[2] = {};
  for (int k = 0; k < 2; ++k) {
    Simulation world = compile(rods(1), Realtime{.substeps = 4 << k, .solver = Solver::SequentialImpulses});
    for (int i = 0; i < 60; ++i) world.step(), gap[k] = std::fmax(gap[k], hinge_gap(world));
  }
  EXPECT_NEAR(std::log2(gap[0] / gap[1]), 2, 0.1);
  EXPECT_LT(gap[0], 1e-3);
}

// A point mass on a massless bar of 1 m from 90 degrees: T = 1.18034059901610 * 2 pi sqrt(l/g).
TEST(Joints, DistanceJointSwingsAsAPendulum) {
  Scene scene = with(empty_scene(), {disc("bob", {1, 0}, 0.1)});
  scene.bodies[0].inertia = 1;
  scene.joints = {DistanceJoint{"bar", std::string(kWorld), "bob", {}, {}, 1}};
  const double period = 1.18034059901610 * 2 * 3.14159265358979323846 * std::sqrt(1 / kGravity);
  Simulation world = compile(scene, Realtime{.dt = period / 160});
  double longest = 0;
  for (int i = 0; i < 160; ++i) {
    world.step();
    longest = std::fmax(longest, std::abs(std::sqrt(length_squared(world.state(0).position)) - 1));
  }
  EXPECT_LT(longest, 1e-3);  // a soft row under three times the weight
  // At the turning point the position's error is second order in the velocity's: look at the velocity too.
  EXPECT_NEAR(world.state(0).position.x, 1, 1e-3);
  EXPECT_NEAR(world.state(0).velocity.y, 0, 1e-2);
}

TEST(Joints, EulerSteppersAreOfFirstOrder) {
  const Vec2d exact{-1.66211513581613, -1.04146663719322};
  double error[2];
  for (int k = 0; k < 2; ++k) {
    Realtime accuracy = with_integrator(Integrator::SemiImplicitEuler);
    accuracy.substeps = 32 << k;
    Simulation world = compile(rods(2), accuracy);
    world.step(60);
    error[k] = std::sqrt(length_squared(tip(world) - exact));
  }
  EXPECT_NEAR(std::log2(error[0] / error[1]), 1, 0.15);
}

// Joints that are apart at the start come together without a burst.
TEST(Joints, GapAtTheStartClosesGently) {
  Scene scene = rods(1);
  scene.gravity = {0, 0};
  scene.bodies[0].position.x += 0.2;
  Simulation world = compile(scene);
  double fastest = 0;
  for (int i = 0; i < 60; ++i) {
    world.step();
    fastest = std::fmax(fastest, std::sqrt(length_squared(world.state(0).velocity)));
  }
  EXPECT_LT(hinge_gap(world), 1e-12);
  EXPECT_LT(fastest, 1e-12);
}

// Two bars between the same two bodies at the same anchors: one row depends on the other.
TEST(Joints, DependentJointsAreHeld) {
  Scene scene = with(empty_scene(), {disc("bob", {1, 0}, 0.1)});
  for (const char* name : {"bar", "same bar"})
    scene.joints.push_back(DistanceJoint{name, std::string(kWorld), "bob", {}, {}, 1});
  Simulation world = compile(scene);
  for (int i = 0; i < 120; ++i) {
    world.step();
    EXPECT_NEAR(length_squared(world.state(0).position), 1, 2e-3);
  }
}

}  // namespace
}  // namespace plumb
