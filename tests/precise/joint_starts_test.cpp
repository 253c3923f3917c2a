#include "engine/precise/dynamics/initial_joint_errors.h"

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
    const auto said = describe_joint_errors(row.scene, 1e-7, 1e-7);
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
  const auto said = describe_joint_errors(moving, 1e-7, 1e-7);
  ASSERT_EQ(said.size(), 1u);
  EXPECT_EQ(said[0], "joint 'weld' holds what moves at 3 m/s where the scene starts");
  EXPECT_TRUE(describe_joint_errors(rods(5), 1e-12, 1e-12).empty());
}

// An impulse of both hinges acts on a bar that spins beside a hinge at rest and carries a weight. By least
// constraint w' = I w / (I + m r^2 + (2 r)^2 M J / (J + M s^2)).
TEST(JointStarts, HingesThatMoveApartAreStruckWhateverTheyCarry) {
  const double r = 3, inertia = 4, spin = -6, s = 5;
  for (const double weight : {2.0, 200.0, 4000.0, 1e6}) {
    const double turned = 20 * weight;
    Scene scene{.name = "struck", .gravity = {}};
    scene.bodies = {{.name = "bar", .position = {0, -r}, .angular_velocity = spin, .inertia = inertia},
                    {.name = "weight", .position = {0, -2 * r - s}, .mass = weight, .inertia = turned}};
    scene.joints = {
        RevoluteJoint{.name = "top", .body_a = std::string(kWorld), .body_b = "bar", .anchor_b = {0, r}},
        RevoluteJoint{
            .name = "tip", .body_a = "bar", .body_b = "weight", .anchor_a = {0, -r}, .anchor_b = {0, s}}};
    Simulation simulation = compile(scene, Precise{.max_dt = 1e-6});
    simulation.step();
    const double carried = 4 * r * r * weight * turned / (turned + weight * s * s);
    const double right = inertia * spin / (inertia + r * r + carried);
    // The bar's lever turns by less than w dt in the step.
    EXPECT_NEAR(simulation.state(0).angular_velocity, right, 1e-9 * std::abs(right));
    EXPECT_NEAR(simulation.state(0).velocity.x, right * r, 1e-9 * std::abs(right * r));
  }
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
