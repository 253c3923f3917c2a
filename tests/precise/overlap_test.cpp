#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "engine/scene/error.h"
#include "engine/simulation/simulation.h"
#include "tests/precise/support.h"

// Shapes that lie in each other where a run starts, or where bodies are put: no law says how they part.
namespace plumb {
namespace {

Scene two(const Geometry& geometry, double distance) {
  Scene scene{.name = "two", .gravity = {}};
  for (const std::string name : {"left", "right"}) {
    Body body{.name = name, .position = {name == "left" ? 0 : distance, 0}, .mass = 1, .inertia = 0.1};
    body.shapes = {{.geometry = geometry}};
    scene.bodies.push_back(body);
  }
  return scene;
}

/// The error of the first step; its value in m.
double refusal(Simulation& simulation, std::string& subject) {
  try {
    simulation.step();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::Run);
    EXPECT_EQ(error.field(), "overlap");
    EXPECT_NE(error.problem().find("Realtime"), std::string::npos) << error.problem();
    subject = error.subject();
    return std::stod(error.value());
  }
  ADD_FAILURE() << "not refused";
  return 0;
}

TEST(PreciseOverlap, IsRefusedWithBothNamesAndItsDepth) {
  const struct {
    Geometry geometry;
    double distance, depth;  // m
  } table[] = {{Box{1, 1}, 0.9, 0.1},        {Box{1, 1}, 0.999, 0.001},
               {Box{1, 0.5}, 0.2, 0.5},      {Circle{0.5}, 0.7, 0.3},
               {Circle{0.5}, 0, 1},          {Capsule{{-0.5, 0}, {0.5, 0}, 0.1}, 1.15, 0.05},
               {Circle{0.5}, 1 - 1e-6, 1e-6}};
  for (const auto& row : table) {
    for (const double tolerance : {1e-9, 1e-7}) {
      Simulation simulation = compile(two(row.geometry, row.distance), Precise{.tolerance = tolerance});
      std::string subject;
      EXPECT_NEAR(refusal(simulation, subject), row.depth, 1e-12) << row.distance;
      EXPECT_EQ(subject, "bodies 'left' and 'right'");
      EXPECT_EQ(simulation.time(), 0);
    }
  }
}

// The scene's length is 1 m here: its bodies' largest extent.
TEST(PreciseOverlap, UpToTheToleranceIsNone) {
  for (const double tolerance : {1e-4, 1e-6, 1e-9}) {
    std::string subject;
    Simulation within = compile(two(Box{1, 1}, 1 - 0.3 * tolerance), Precise{.tolerance = tolerance});
    within.step(60);
    EXPECT_EQ(within.state(0).velocity, Vec2d{});
    Simulation beyond = compile(two(Box{1, 1}, 1 - 3 * tolerance), Precise{.tolerance = tolerance});
    EXPECT_NEAR(refusal(beyond, subject), 3 * tolerance, 1e-12);
  }
  std::string subject;  // nor does any tolerance allow a hundredth
  Simulation loose = compile(two(Box{1, 1}, 0.99), Precise{.tolerance = 100});
  EXPECT_NEAR(refusal(loose, subject), 0.01, 1e-12);
}

TEST(PreciseOverlap, WhatRestsWithinTheToleranceIsPutOntoIt) {
  Scene scene = two(Box{1, 1}, 0);
  scene.gravity = {0, -9.81};
  scene.bodies[0].type = BodyType::Static;
  scene.bodies[1].position = {0, 1 - 0.5e-6};
  Simulation simulation = compile(scene, Precise{.tolerance = 1e-6});
  simulation.step(60);
  EXPECT_NEAR(simulation.state(1).position.y, 1, 1e-14);
}

TEST(PreciseOverlap, BodiesPutIntoOthersAreRefused) {
  Simulation simulation = compile(two(Circle{0.5}, 3), Precise{});
  simulation.step(10);
  BodyState state = simulation.state(1);
  state.position = {0.75, 0};
  simulation.set_state(1, state);
  std::string subject;
  EXPECT_NEAR(refusal(simulation, subject), 0.25, 1e-12);
  state.position = {2, 0};  // and may go on once they are apart
  simulation.set_state(1, state);
  simulation.step(10);
  EXPECT_EQ(simulation.state(1).position, (Vec2d{2, 0}));
}

TEST(PreciseOverlap, PairsThatDoNotTouchMayLieInEachOther) {
  Scene filtered = two(Box{1, 1}, 0.5);
  for (Body& body : filtered.bodies) body.shapes[0].filter.group = -1;
  Scene joined = two(Box{1, 1}, 0.5);
  joined.joints.push_back(RevoluteJoint{
      .name = "hinge", .body_a = "left", .body_b = "right", .anchor_a = {0.25, 0}, .anchor_b = {-0.25, 0}});
  Scene behind =
      two(Circle{0.5}, 0.25);  // through the back of a chain, whose front is to the right of its way
  behind.bodies[0].type = BodyType::Static;
  behind.bodies[0].shapes[0].geometry = Chain{{{0, -5}, {0, 5}}};
  behind.bodies[1].position = {-0.25, 0};
  for (const Scene& scene : {filtered, joined, behind}) {
    Simulation simulation = compile(scene, Precise{});
    EXPECT_NO_THROW(simulation.step(10));
  }
}

}  // namespace
}  // namespace plumb
