// The other end of the protocol: engines that are served, and those of docs/adding-an-engine.md.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "engine/scene/error.h"
#include "reference/process_backend.h"
#include "tests/reference/scenes.h"

namespace plumb::reference {
namespace {

using namespace plumb::reference::testing;
using ::testing::HasSubstr;

/// A scene with one of everything.
Scene everything() {
  Scene scene = falling({of_type(box("ground", {0, -0.5}, 20, 1), BodyType::Static), disc("ball", {0.1, 3}),
                         box("block", {0.3, 1}, 1, 0.5, 2), disc("bob", {5, 4}, 0.25),
                         of_type(moving(box("lift", {-4, 1}, 1, 0.2), {0.3, 0}, 0.5), BodyType::Kinematic)});
  scene.bodies[1].shapes[0].restitution = 0.7;
  scene.bodies[1].shapes[0].filter = {.category = 4, .mask = 0xFFFFFFFFu, .group = 0};
  scene.bodies[2].shapes.push_back({.geometry = Circle{0.3}, .position = {0.2, 0.4}, .friction = 0.9});
  scene.bodies[2].inertia = 0.3;
  scene.joints = {RevoluteJoint{
      .name = "pin", .body_a = "world", .body_b = "bob", .anchor_a = {4, 4}, .anchor_b = {-1, 0}}};
  scene.forces = {
      LinearDrag{.body = "ball", .coefficient = 0.1},
      PointForce{.body = "block", .force = {2, 1}, .point = {0.1, 0.2}, .frame = Frame::Body, .start = 0.2}};
  return scene;
}

TEST(Worker, ServesTheSameBitsAsTheEngineCalledDirectly) {
  const Scene scene = everything();
  for (const char* name : {"box2d", "bullet"}) {
    const Backend& direct = find_backend(name);
    const auto served = make_process_backend("served", {PLUMB_TEST_WORKER, name});
    ASSERT_TRUE(served->identity().available) << served->identity().reason;
    EXPECT_EQ(served->identity().version, direct.identity().version);
    EXPECT_EQ(served->identity().precision, direct.identity().precision);
    EXPECT_EQ(served->options().size(), direct.options().size());
    EXPECT_EQ(served->method({.dt = 0.1, .substeps = 5}).substep,
              direct.method({.dt = 0.1, .substeps = 5}).substep);
    const StepSettings settings{.dt = 1.0 / 60, .substeps = 2};
    EXPECT_EQ(served->effective_settings(scene, settings), direct.effective_settings(scene, settings));
    EXPECT_EQ(served->unsupported(scene, settings), "");

    std::vector<std::vector<BodyState>> expected, got;
    const auto record = [&](const Backend& engine, auto& out) {
      const auto simulator = engine.create(scene, settings);
      for (const int every : {1, 7}) {
        EXPECT_GT(simulator->record(
                      20, every, scene.bodies.size(),
                      [&](double, std::span<const BodyState> s) { out.emplace_back(s.begin(), s.end()); }),
                  0);
      }
      EXPECT_NEAR(simulator->time(), 160.0 / 60, 1e-12);
    };
    record(direct, expected);
    record(*served, got);
    EXPECT_EQ(expected, got) << name;
  }
}

TEST(Worker, ReportsTypedErrorsAndReasons) {
  const auto served = make_process_backend("served", {PLUMB_TEST_WORKER, "box2d"});
  Scene scene = falling({disc("bob", {})});
  scene.joints = {DistanceJoint{.name = "rod", .body_a = "bob", .body_b = "world", .length = 0.004}};
  EXPECT_EQ(served->unsupported(scene, {}), find_backend("box2d").unsupported(scene, {}));
  try {
    served->effective_settings(scene, {.options = {{"velocity_iterations", "many"}}});
    ADD_FAILURE() << "nothing was thrown";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::Value);
    EXPECT_EQ(error.field(), "velocity_iterations");
  }
  // Still there, and still right.
  scene.joints.clear();
  EXPECT_EQ(served->unsupported(scene, {}), "");
}

TEST(Worker, SaysThatAStateIsNotFinite) {
  // Ten steps of 1e17 m/s^2 s: the drag of the last step's velocity is beyond float, and then infinite.
  Scene scene = weightless({moving(disc("bob", {}), {1e15, 0})});
  scene.forces = {QuadraticDrag{.body = "bob", .coefficient = 1e10}};
  const auto served = make_process_backend("served", {PLUMB_TEST_WORKER, "bullet"});
  try {
    served->create(scene, {})->advance(10);
    ADD_FAILURE() << "nothing was thrown";
  } catch (const ProcessError& error) {
    EXPECT_EQ(error.fault(), ProcessError::Fault::Diverged);
    EXPECT_THAT(error.what(), HasSubstr("not finite"));
  }
}

/// Free flight of a page's example, over the whole of it: exact but for rounding.
void expect_parabolas(const Backend& engine) {
  Scene scene =
      falling({moving(disc("ball", {1, 2}), {3, 4}, 5), of_type(disc("rock", {20, 0}), BodyType::Static)});
  for (Body& body : scene.bodies) body.shapes[0].filter.mask = 0;
  ASSERT_TRUE(engine.identity().available) << engine.identity().reason;
  ASSERT_EQ(engine.unsupported(scene, {}), "");
  EXPECT_EQ(engine.method({}).order, 2);
  const auto simulator = engine.create(scene, {.dt = 0.125});
  int samples = 0;
  const double ns = simulator->record(8, 2, 2, [&](double t, std::span<const BodyState> states) {
    ++samples;
    EXPECT_DOUBLE_EQ(t, samples * 0.25);
    EXPECT_NEAR(states[0].position.x, 1 + 3 * t, 1e-14);
    EXPECT_NEAR(states[0].position.y, 2 + 4 * t - 9.81 * t * t / 2, 1e-14);
    EXPECT_NEAR(states[0].angle, 5 * t, 1e-14);
    EXPECT_NEAR(states[0].velocity.y, 4 - 9.81 * t, 1e-14);
    EXPECT_EQ(states[1].position, (Vec2d{20, 0}));
  });
  EXPECT_EQ(samples, 8);
  EXPECT_GE(ns, 0);
}

TEST(DocumentedEngine, TheFileInCppIsACompleteEngine) {
  expect_parabolas(find_backend("ballistic"));
  EXPECT_THAT(find_backend("ballistic").unsupported(head_on(), {}), HasSubstr("no contacts"));
}

TEST(DocumentedEngine, TheFileInPythonIsACompleteEngine) {
  ASSERT_EQ(std::system("python3 -c pass"), 0) << "the documented engine is written in Python 3";
  const auto engine = make_process_backend("ballistic", {"python3", PLUMB_DOC_ENGINE});
  expect_parabolas(*engine);
  EXPECT_THAT(engine->unsupported(head_on(), {}), HasSubstr("may touch, and it has no contacts"));
}

}  // namespace
}  // namespace plumb::reference
