#include "demos/core/view_scene.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/scene/error.h"
#include "engine/simulation/simulation.h"
#include "tests/demos/play.h"

namespace plumb::demos {
namespace {

Scene oscillator() {
  Scene scene{.name = "oscillator", .gravity = {0, 0}};
  scene.bodies = {
      {.name = "ball", .position = {1, 0}, .mass = 2, .shapes = {{.geometry = Circle{0.1}}}},
      {.name = "free", .position = {0, 5}, .velocity = {1, 0}, .shapes = {{.geometry = Box{1, 1}}}}};
  scene.forces = {SpringForce{.body_a = "world", .body_b = "ball", .stiffness = 8}};
  return scene;
}

// Bodies move as the scene says, force laws too: x = cos(w t), w = sqrt(k / m) = 2 / s. The midpoint force of
// a step is right to (w dt)^2 / 24 of the phase.
TEST(ViewScene, FollowsTheScene) {
  SceneDemo demo(oscillator(), "a spring");
  EXPECT_EQ(demo.about().name, "oscillator");
  std::vector<BodyState> states(2);
  for (int n = 1; n <= 180; ++n) {
    demo.step_once();
    demo.read_states(states);
    const double t = n * demo.dt(), phase = 2 * t;
    EXPECT_NEAR(states[0].position.x, std::cos(phase), phase * 4 * demo.dt() * demo.dt() / 6);
    EXPECT_NEAR(states[1].position.x, t, 1e-5);
  }
}

// Scenes with everything that acts in the course of a step: laws that depend on the motion and on time, a
// prescribed motion, a drive of a motor, and contacts.
std::vector<Scene> busy_scenes() {
  Scene laws = oscillator();
  laws.forces.push_back(LinearDrag{.body = "free", .coefficient = 2});
  laws.forces.push_back(SinusoidalForce{.body = "free", .amplitude = {0, 5}, .angular_frequency = 20});
  Scene carried{.name = "carried"};
  carried.bodies = {{.name = "lift",
                     .type = BodyType::Kinematic,
                     .shapes = {{.geometry = Box{4, 0.5}}},
                     .motion = {.y = "sin(3*t)"}},
                    {.name = "crate", .position = {0, 0.75}, .shapes = {{.geometry = Box{1, 1}}}}};
  Scene driven{.name = "driven"};
  driven.bodies = {{.name = "arm", .position = {1, 0}, .shapes = {{.geometry = Box{2, 0.2}}}}};
  RevoluteJoint hinge;
  hinge.name = "hinge", hinge.body_a = "world", hinge.body_b = "arm", hinge.anchor_b = {-1, 0};
  hinge.motor = Motor{.speed = 0, .max_force = 1e4};
  driven.joints = {hinge};
  driven.drives = {{.joint = "hinge", .speed = "4*sin(5*t)"}};
  Scene falling{.name = "falling"};
  falling.bodies = {
      {.name = "floor", .type = BodyType::Static, .shapes = {{.geometry = Box{9, 1}}}},
      {.name = "ball", .position = {0, 2}, .shapes = {{.geometry = Circle{0.5}, .restitution = 0.5}}}};
  return {laws, carried, driven, falling};
}

// The view is the same engine as in a comparison: to the bit, with the same step, substeps and solver.
TEST(ViewScene, MovesAsASimulationWithTheSameSettings) {
  for (const Scene& scene : busy_scenes()) {
    for (const int substeps : {1, 2, 4, 16}) {
      for (const double dt : {1.0 / 60, 0.005}) {
        for (int solver = 0; solver < 5; ++solver) {
          SceneDemo demo(scene, "");
          demo.set("substeps", substeps), demo.set("dt", dt), demo.set("solver", solver);
          demo.restart();
          Simulation simulation = compile(scene, Realtime{.dt = dt,
                                                          .substeps = substeps,
                                                          .precision = Precision::Float,
                                                          .solver = static_cast<Solver>(solver),
                                                          .sleeping = false});
          steps(demo, 100);
          simulation.step(100);
          std::vector<BodyState> seen(scene.bodies.size()), expected(scene.bodies.size());
          demo.read_states(seen);
          simulation.read(expected);
          for (std::size_t i = 0; i < seen.size(); ++i) {
            SCOPED_TRACE(scene.name + ", body " + scene.bodies[i].name + ", substeps " +
                         std::to_string(substeps) + ", dt " + std::to_string(dt) + ", solver " +
                         kSolverNames[solver]);
            EXPECT_EQ(seen[i].position, expected[i].position);
            EXPECT_EQ(seen[i].angle, expected[i].angle);
            // Velocities of a prescribed body are those of its path at a time that is summed in another
            // order.
            const double rounding = scene.bodies[i].type == BodyType::Kinematic ? 1e-12 : 0;
            EXPECT_NEAR(seen[i].velocity.x, expected[i].velocity.x, rounding);
            EXPECT_NEAR(seen[i].velocity.y, expected[i].velocity.y, rounding);
            EXPECT_NEAR(seen[i].angular_velocity, expected[i].angular_velocity, rounding);
          }
        }
      }
    }
  }
}

TEST(ViewScene, SaysInSentencesHowToPlay) {
  EXPECT_EQ(SceneDemo(oscillator(), "a spring").about().play, "A spring. Drag bodies with the pointer.");
  EXPECT_EQ(SceneDemo(oscillator(), "").about().play, "Drag bodies with the pointer.");
}

TEST(ViewScene, SolversAndStepsAreChosen) {
  SceneDemo demo(oscillator(), "a spring");
  for (int i = 0; i < 5; ++i) {
    demo.set("solver", i);
    EXPECT_EQ(demo.world()->solver(), static_cast<Solver>(i));
    steps(demo, 5);
  }
  demo.set("iterations", 50);
  EXPECT_EQ(demo.world()->iterations(), 50);
}

TEST(ViewScene, ShowsWhatThereIsToSee) {
  const Aabb<double> view = SceneDemo(oscillator(), "").view();
  EXPECT_TRUE(view.contains({{0, -0.1}, {1.1, 5.5}}));
  EXPECT_LT(view.half_perimeter(), 20);
  const Aabb<double> given{{-1, -2}, {3, 4}};
  EXPECT_EQ(SceneDemo(oscillator(), "", given).view().upper, given.upper);
}

// The camera holds bodies that fall out of the view, also those that collide with nothing.
TEST(ViewScene, TheCameraFollowsBodiesThatMeetNothing) {
  Scene scene{.name = "falls", .gravity = {0, -10}};
  scene.bodies = {{.name = "ball", .shapes = {{.geometry = Circle{0.5}, .filter = {.mask = 0}}}}};
  SceneDemo demo(scene, "");
  steps(demo, 180);
  std::vector<BodyState> states(1);
  demo.read_states(states);
  const Vec2d centre = states[0].position;
  EXPECT_LT(centre.y, -40);
  EXPECT_TRUE(demo.shown().contains({centre - Vec2d{0.49, 0.49}, centre + Vec2d{0.49, 0.49}}));
}

TEST(ViewScene, BodiesCanBeDragged) {
  SceneDemo demo(oscillator(), "");
  std::vector<BodyState> states(2);
  demo.press({0.3, 5.3});
  demo.drag({2, 3});
  steps(demo, 120);
  demo.read_states(states);
  EXPECT_NEAR(states[1].position.y, 3, 1);
  demo.release({2, 3});
  const std::vector<std::byte> saved = demo.save();
  steps(demo, 30);
  const std::uint64_t later = demo.hash();
  demo.restore(saved);
  steps(demo, 30);
  EXPECT_EQ(demo.hash(), later);
}

// Bodies that touch nothing, such as the rods of a chain, are not found by queries, and can be grabbed all
// the same.
TEST(ViewScene, WhatTouchesNothingCanBeDragged) {
  Scene scene = oscillator();
  for (Body& body : scene.bodies) body.shapes[0].filter.mask = 0;
  scene.bodies[1].velocity = {};
  SceneDemo demo(scene, "");
  std::vector<BodyState> states(2);
  demo.press({0.48, 5.48});  // near a corner of the box, far from its centre
  demo.drag({2, 3});
  steps(demo, 120);
  demo.read_states(states);
  EXPECT_NEAR(states[1].position.y, 3, 1);
  EXPECT_LT(states[0].position.x, 1.01);  // the other one swings as it would
  demo.release({2, 3});
  demo.press({40, 40});  // out of reach of everything
  demo.drag({41, 40});
  const Vec2d before = states[1].position;
  steps(demo, 1);
  demo.read_states(states);
  EXPECT_LT(length_squared(states[1].position - before), 1);
}

// Outlines of a body in any state: what ghosts are drawn with.
class Log : public DebugDraw {
 public:
  void polygon(std::span<const Vec2d> corners, double radius, DrawRole) override {
    points.assign(corners.begin(), corners.end());
    rounding = radius;
  }
  void circle(Vec2d centre, double radius, Vec2d, DrawRole) override { points = {centre}, rounding = radius; }
  void capsule(Vec2d start, Vec2d end, double radius, DrawRole) override {
    points = {start, end}, rounding = radius;
  }
  void segment(Vec2d start, Vec2d end, DrawRole) override { points = {start, end}, rounding = 0; }
  void point(Vec2d point, DrawRole) override { points = {point}; }
  void text(Vec2d, std::string_view, DrawRole) override {}
  std::vector<Vec2d> points;
  double rounding = -1;
};

void expect_points(const Log& log, const std::vector<Vec2d>& expected) {
  ASSERT_EQ(log.points.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_NEAR(log.points[i].x, expected[i].x, 1e-12);
    EXPECT_NEAR(log.points[i].y, expected[i].y, 1e-12);
  }
}

// A body at (3, 4), turned by a quarter: a local point (x, y) is at (3 - y, 4 + x).
TEST(ViewScene, DrawsBodiesWhereTheyAre) {
  const BodyState state{.position = {3, 4}, .angle = std::acos(0.0)};
  const auto drawn = [&](const Geometry& geometry) {
    Log log;
    draw_body({.name = "body", .shapes = {{.geometry = geometry, .position = {1, 0}}}}, state, log,
              DrawRole::Awake);
    return log;
  };
  expect_points(drawn(Circle{0.5}), {{3, 5}});
  EXPECT_EQ(drawn(Circle{0.5}).rounding, 0.5);
  expect_points(drawn(Box{2, 4}), {{5, 4}, {5, 6}, {1, 6}, {1, 4}});
  expect_points(drawn(Capsule{{0, 1}, {0, 2}, 0.25}), {{2, 5}, {1, 5}});
  expect_points(drawn(Segment{{0, 1}, {0, 2}}), {{2, 5}, {1, 5}});
  // Scenes give a polygon's points in any order; what draws wants corners, counter-clockwise.
  const Polygon triangle{{{0, 0}, {0.2, 0.2}, {0, 1}, {1, 0}}, 0.1};
  expect_points(drawn(triangle), {{3, 5}, {3, 6}, {2, 5}});
}

TEST(ViewScene, RefusesWhatNoWorldHas) {
  Scene scene = oscillator();
  scene.bodies[0].mass = -1;
  EXPECT_THROW(SceneDemo(scene, ""), Error);
}

}  // namespace
}  // namespace plumb::demos
