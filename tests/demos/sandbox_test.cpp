#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>

#include "engine/scene/json.h"
#include "engine/simulation/simulation.h"
#include "tests/demos/play.h"

// The sandbox, and what every demo has for a player's hands and eyes: a scene, arrows, a camera, a grip.
namespace plumb::demos {
namespace {

std::unique_ptr<Demo> sandbox() {
  std::unique_ptr<Demo> demo = make("sandbox");
  demo->key('c');
  return demo;
}

void build(Demo& demo, const char* tool, Vec2d from, Vec2d to) {
  demo.set("tool", tool);
  pull(demo, from, to);
}

TEST(Sandbox, ADragMakesTheShapeOfTheTool) {
  const std::unique_ptr<Demo> demo = sandbox();
  demo->set("density", 2.0);
  build(*demo, "box", {-4, 3}, {-2, 4});
  build(*demo, "circle", {0, 3}, {0.5, 3});
  build(*demo, "triangle", {2, 3}, {3, 4});
  build(*demo, "wall", {-3, 1}, {3, 2});
  const DemoWorld& world = *demo->world();
  const BodyId box = body_called(*demo, "box"), ball = body_called(*demo, "ball");
  EXPECT_NEAR(world.mass(box), 2 * 2 * 1, 1e-5);
  EXPECT_NEAR(world.position(box).x, -3, 1e-6);
  EXPECT_NEAR(world.position(box).y, 3.5, 1e-6);
  EXPECT_NEAR(world.mass(ball), 2 * M_PI * 0.25, 1e-5);
  EXPECT_NEAR(world.mass(body_called(*demo, "triangle")), 2 * 0.5, 1e-5);
  EXPECT_EQ(world.type(body_called(*demo, "wall")), BodyType::Static);
}

TEST(Sandbox, MaterialsAreThoseOfTheControls) {
  const std::unique_ptr<Demo> demo = sandbox();
  demo->set("friction", 1.25);
  build(*demo, "box", {-4, 3}, {-2, 4});
  const BodyId box = body_called(*demo, "box");
  const ShapeId shape = demo->world()->shapes(box).front();
  EXPECT_NEAR(demo->world()->material(shape).friction, 1.25, 1e-6);
  demo->set("restitution", 0.75);
  demo->set("density", 5.0);
  build(*demo, "paint", {-3, 3.5}, {-3, 3.5});
  EXPECT_NEAR(demo->world()->material(shape).restitution, 0.75, 1e-6);
  EXPECT_NEAR(demo->world()->mass(box), 10, 1e-4);
}

// A weight on a rod from the background keeps its distance; on a hinge it swings; erased, it falls.
TEST(Sandbox, JointsHoldFromThePressToTheRelease) {
  for (const char* tool : {"rod", "rope", "spring", "hinge", "weld"}) {
    const std::unique_ptr<Demo> demo = sandbox();
    build(*demo, "circle", {1, 4}, {1.3, 4});
    const bool at_a_point = std::string_view(tool) == "hinge" || std::string_view(tool) == "weld";
    build(*demo, tool, at_a_point ? Vec2d{1.2, 4} : Vec2d{0, 5}, at_a_point ? Vec2d{1.2, 4} : Vec2d{1, 4});
    ASSERT_EQ(figure(*demo, "joints"), 1) << tool;
    const BodyId ball = body_called(*demo, "ball");
    const Vec2d hook = at_a_point ? Vec2d{1.2, 4} : Vec2d{0, 5};
    const double length = at_a_point ? 0.2 : std::sqrt(2);
    steps(*demo, 120);
    const double distance = std::sqrt(length_squared(demo->world()->centre(ball) - hook));
    EXPECT_NEAR(distance, length, std::string_view(tool) == "spring" ? 0.5 : 0.02) << tool;
    build(*demo, "erase", demo->world()->centre(ball), demo->world()->centre(ball));
    EXPECT_TRUE(bodies_called(*demo, "ball").empty());
    EXPECT_EQ(figure(*demo, "joints"), 0) << tool;
  }
}

// Checks that a saved scene goes on as the demo does: a world of the scene has the same bodies and
// joints, and keeps to the demo's motion as far as float reaches in a second without impacts.
TEST(Sandbox, ItsSceneRunsAsItDoes) {
  const std::unique_ptr<Demo> demo = sandbox();
  demo->set("gravity", 3.0);
  build(*demo, "box", {-1.5, 4}, {-0.5, 4.4});
  build(*demo, "rod", {0, 6}, {-0.7, 4.2});
  build(*demo, "circle", {3, 5}, {3.2, 5});
  build(*demo, "spring", {4, 6}, {3, 5});
  steps(*demo, 30);
  const std::optional<Scene> scene = demo->scene();
  ASSERT_TRUE(scene.has_value());
  const Scene read = scene_from_json(to_json(*scene));
  EXPECT_EQ(read.joints.size(), 2u);
  Simulation again = compile(read, Realtime{.dt = demo->dt(), .substeps = 4});
  for (int i = 0; i < 60; ++i) again.step();
  steps(*demo, 60);
  for (std::size_t i = 0; i < read.bodies.size(); ++i) {
    if (read.bodies[i].type != BodyType::Dynamic) continue;
    const BodyId body = body_called(*demo, read.bodies[i].name);
    EXPECT_NEAR(again.state(i).position.x, demo->world()->centre(body).x, 0.01) << read.bodies[i].name;
    EXPECT_NEAR(again.state(i).position.y, demo->world()->centre(body).y, 0.01) << read.bodies[i].name;
  }
}

// Keeps the arrows and labels of the motion.
struct Arrows : DebugDraw {
  void polygon(std::span<const Vec2d>, double, DrawRole) override {}
  void circle(Vec2d, double, Vec2d, DrawRole) override {}
  void capsule(Vec2d, Vec2d, double, DrawRole) override {}
  void segment(Vec2d start, Vec2d end, DrawRole role) override { segments.push_back({start, end, role}); }
  void point(Vec2d, DrawRole) override {}
  void text(Vec2d, std::string_view text, DrawRole) override { texts.emplace_back(text); }
  struct Line {
    Vec2d start, end;
    DrawRole role;
  };
  std::vector<Line> segments;
  std::vector<std::string> texts;
};

// A ball that falls: its velocity's arrow points down and grows with it, that of the force on it is its
// weight and stays. Three lines make an arrow, the first of them its shaft.
TEST(Motion, ArrowsPointAlongVelocityAndForce) {
  const std::unique_ptr<Demo> demo = make("drop");
  const auto shaft = [&](MotionOptions options) {
    Arrows arrows;
    demo->draw_motion(arrows, options);
    EXPECT_EQ(arrows.segments.size(), 3u);
    return arrows.segments.empty() ? Vec2d{} : arrows.segments[0].end - arrows.segments[0].start;
  };
  steps(*demo, 10);
  const Vec2d velocity = shaft({.velocities = true}), force = shaft({.forces = true});
  steps(*demo, 10);
  EXPECT_NEAR(shaft({.velocities = true}).y / velocity.y, 2, 1e-4);
  EXPECT_NEAR(shaft({.forces = true}).y / force.y, 1, 1e-4);
  EXPECT_LT(velocity.y, 0);
  EXPECT_LT(force.y, 0);
  EXPECT_NEAR(shaft({.velocities = true, .length = 2}).y / velocity.y, 4, 1e-4);
  Arrows labels;
  demo->draw_motion(labels, {.masses = true});
  EXPECT_THAT(labels.texts, testing::ElementsAre("1 kg"));
}

// The camera holds what has left the view, and no more than twice the view.
TEST(Motion, TheCameraFollowsWhatMoves) {
  const std::unique_ptr<Demo> demo = make("cannonballs");
  demo->set("balls", "light (1 kg)");
  const Aabb<double> home = demo->view();
  EXPECT_EQ(demo->shown().upper, home.upper);
  demo->set("impulse", 60.0);
  click(*demo, {12, 12});
  double widest = 0;
  for (int i = 0; i < 360; ++i) {
    demo->step_once();
    const Aabb<double> shown = demo->shown();
    for (const Moving& each : demo->moving()) {
      if (!each.awake) continue;
      EXPECT_TRUE(shown.contains(each.box)) << "after " << demo->time() << " s";
      widest = std::max(widest, each.centre.x);
    }
    EXPECT_LE(shown.upper.x - shown.lower.x, 2 * (home.upper.x - home.lower.x) + 1e-9);
  }
  EXPECT_GT(widest, home.upper.x + 30);
  demo->key('c');
  steps(*demo, 300);  // the crates fall asleep
  EXPECT_EQ(demo->shown().upper, home.upper);
}

// In demos whose press has another meaning, `g` makes it a grip: a body is carried and thrown.
TEST(Motion, BodiesAreGrabbedAndThrownInEveryDemo) {
  struct Case {
    const char *demo, *body;
  };
  for (const Case& each : {Case{"pool_break", "cue"}, Case{"spinning_boxes", "square"},
                           Case{"cannonballs", "crate"}, Case{"ragdoll", "torso"}, Case{"sandbox", "ball"}}) {
    const std::unique_ptr<Demo> demo = make(each.demo);
    if (!std::ranges::none_of(demo->about().keys, [](const Key& key) { return key.key == 'g'; }))
      demo->key('g');
    const BodyId body = body_called(*demo, each.body);
    const Vec2d start = demo->world()->centre(body);
    const Vec2d way = 0.1 * Vec2d{0, demo->view().upper.y - demo->view().lower.y};
    demo->press(start);
    constexpr int kFrames = 40;
    for (int i = 1; i <= kFrames; ++i) {
      demo->drag(start + (1.0 * i / kFrames) * way);
      demo->step_once();
    }
    const double half = 0.5 * std::sqrt(length_squared(way));
    EXPECT_LT(std::sqrt(length_squared(demo->world()->centre(body) - start - way)), 1.5 * half) << each.demo;
    demo->release(start + way);
    EXPECT_GT(demo->world()->velocity(body).y, 0) << each.demo;
  }
  const std::unique_ptr<Demo> ball = make("bouncing_ball");
  ball->press({4, 3});
  for (int i = 1; i <= 60; ++i) {
    ball->drag({4 + 0.02 * i, 3});
    ball->step_once();
  }
  ball->release({5.2, 3});
  // The hand moves at 0.02 m a step of 1/60 s.
  EXPECT_NEAR(ball->moving()[0].velocity.x, 1.2, 0.02);
}

}  // namespace
}  // namespace plumb::demos
