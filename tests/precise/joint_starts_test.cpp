#include "engine/precise/dynamics/joint_starts.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "engine/scene/error.h"
#include "engine/simulation/simulation.h"
#include "tests/precise/support.h"

// Joints that do not fit where their scene starts.
namespace plumb {
namespace {

Scene two(const Joint& joint, Vec2d at = {1, 0}) {
  Scene scene{.name = "two", .gravity = {}};
  scene.bodies = {{.name = "a", .inertia = 0.1}, {.name = "b", .position = at, .inertia = 0.1}};
  scene.joints = {joint};
  return scene;
}

/// Returns what Precise refuses to start with: the figure, and the joint.
std::string refused(const Scene& scene, double tolerance, double& figure) {
  Simulation simulation = compile(scene, Precise{.tolerance = tolerance});
  try {
    simulation.step();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::Run) << error.what();
    EXPECT_EQ(error.field(), "gap");
    EXPECT_EQ(simulation.time(), 0);
    figure = std::stod(error.value());
    return error.subject();
  }
  return {};
}

TEST(JointStarts, WhatIsOpenOrTooLongIsRefusedByPreciseWithItsFigure) {
  RevoluteJoint hinge{"hip", "a", "b", {0.5, 0}, {-0.5, 0}, false};
  DistanceJoint rod{.name = "rod", .body_a = "a", .body_b = "b", .length = 0.9};
  DistanceJoint rope = rod;
  rope.name = "rope", rope.range = Range{0, 0.75};
  WeldJoint weld{.name = "weld", .body_a = "a", .body_b = "b", .anchor_a = {1, 0}};
  PrismaticJoint rail{.name = "rail", .body_a = "a", .body_b = "b"};
  const struct {
    Scene scene;
    std::string subject;
    double figure;
  } table[] = {{two(hinge, {1.01, 0}), "joint 'hip'", 0.01},
               {two(hinge, {1, 1e-6}), "joint 'hip'", 1e-6},
               {two(rod), "joint 'rod'", 0.1},
               {two(rope), "joint 'rope'", 0.25},
               {two(weld, {1, 0.002}), "joint 'weld'", 0.002},
               {two(rail, {1, -0.03}), "joint 'rail'", 0.03}};
  for (const auto& row : table) {
    double figure = 0;
    EXPECT_EQ(refused(row.scene, 1e-9, figure), row.subject);
    EXPECT_NEAR(figure, row.figure, 1e-12) << row.subject;
    const auto said = joint_complaints(row.scene, 1e-7, 1e-7);
    ASSERT_EQ(said.size(), 1u) << row.subject;
    EXPECT_EQ(said[0].find(row.subject), 0u) << said[0];
  }
}

TEST(JointStarts, UpToTheToleranceIsNone) {
  for (const double tolerance : {1e-4, 1e-6, 1e-9}) {
    double figure = 0;
    const auto hinge = [&](double open) {
      return two(RevoluteJoint{"hip", "a", "b", {0.5, 0}, {-0.5, 0}, false}, {1 + open, 0});
    };
    EXPECT_EQ(refused(hinge(0.5 * tolerance), tolerance, figure), "");
    EXPECT_EQ(refused(hinge(3 * tolerance), tolerance, figure), "joint 'hip'");
  }
}

TEST(JointStarts, AngularFitsAndSpeedsAreNamedInTheirUnits) {
  WeldJoint weld{.name = "weld", .body_a = "a", .body_b = "b", .anchor_a = {1, 0}};
  Scene turned = two(weld);
  turned.bodies[1].angle = 0.02;
  double figure = 0;
  EXPECT_EQ(refused(turned, 1e-9, figure), "joint 'weld'");
  EXPECT_NEAR(figure, 0.02, 1e-12);
  Scene moving = two(weld);
  moving.bodies[1].velocity = {0, 3};
  const auto said = joint_complaints(moving, 1e-7, 1e-7);
  ASSERT_EQ(said.size(), 1u);
  EXPECT_EQ(said[0], "joint 'weld' holds what moves at 3 m/s where the scene starts");
  EXPECT_TRUE(joint_complaints(rods(5), 1e-12, 1e-12).empty());
}

TEST(JointStarts, BodiesThatArePutElsewhereAreClosedAtOnce) {
  Simulation simulation = compile(rods(2), Precise{});
  BodyState tip = simulation.state(1);
  tip.position.x += 0.01;
  simulation.set_state(1, tip);
  simulation.step();
  EXPECT_LT(check_rods({simulation.state(0), simulation.state(1)}).gap, 1e-14);
}

TEST(Tolerances, BelowWhatDoublesResolveAreAnErrorNotClipped) {
  for (const double tolerance : {9.9e-13, 1e-15, 1e-100}) {
    try {
      (void)compile(rods(1), Precise{.tolerance = tolerance});
      ADD_FAILURE() << tolerance;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), Error::Kind::Value);
      EXPECT_EQ(error.field(), "tolerance");
      EXPECT_NE(error.problem().find("1e-12"), std::string::npos) << error.problem();
    }
  }
  EXPECT_NO_THROW((void)compile(rods(1), Precise{.tolerance = 1e-12}));
}

}  // namespace
}  // namespace plumb
