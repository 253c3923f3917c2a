#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "engine/simulation/simulation.h"
#include "engine/simulation/world_plan.h"
#include "tests/simulation/scenes.h"

namespace plumb {
namespace {

using namespace plumb::testing;

std::string active_stages(const Scene& scene, const Realtime& accuracy = {}) {
  std::string out;
  const Plan plan = plan_world(scene, accuracy, false);
  for (const Stage& stage : plan.stages) {
    EXPECT_FALSE(stage.why.empty()) << stage.name;
    if (stage.active) out += (out.empty() ? "" : " ") + stage.name;
  }
  return out;
}

Scene dragged(Scene scene) {
  scene.forces = {LinearDrag{"a", 0.1}};
  return scene;
}

Scene pushed(Scene scene) {
  scene.forces = {PointForce{"a", {1, 0}, {0, 0.1}}};
  return scene;
}

Scene rotation_fixed(Scene scene) {
  for (Body& body : scene.bodies) body.fixed_rotation = true;
  return scene;
}

Scene never_touching(Scene scene) {
  for (Body& body : scene.bodies)
    for (Shape& shape : body.shapes) shape.filter.group = -1;
  return scene;
}

TEST(Plan, WhichSceneRunsWhichStages) {
  const Scene one = with(empty_scene(), {disc("a", {0, 0})});
  const Scene two = with(empty_scene(), {disc("a", {0, 0}), disc("b", {3, 0})});
  Scene excluded = two;
  excluded.joints = {DistanceJoint{"bar", "a", "b", {}, {}, 3}};
  const Scene plates =
      with(empty_scene(), {plane(), fixed(box("b", {0, 3}, 1, 1)), fixed(box("c", {0, 3}, 1, 1))});

  const struct {
    const char* what;
    Scene scene;
    const char* stages;
  } table[] = {
      {"one disc", one, "solver finalize"},
      {"with drag", dragged(one), "forces solver finalize"},
      {"two discs", two, "broad_phase narrow_phase solver finalize continuous events"},
      {"a filter keeps them apart", never_touching(two), "solver finalize"},
      {"a joint keeps them apart", excluded, "solver finalize"},
      {"nothing can move", plates, "solver finalize"},
      {"rods", rods(3), "solver finalize"},
  };
  for (const auto& row : table) EXPECT_EQ(active_stages(row.scene), row.stages) << row.what;
  EXPECT_EQ(active_stages(one, {.sleeping = true, .on_violation = OnViolation::Stop}),
            "solver finalize sleep monitor");
  EXPECT_EQ(active_stages(two, {.continuous = false}), "broad_phase narrow_phase solver finalize events");
}

TEST(Plan, EveryStageIsActiveOnRequest) {
  for (const Stage& stage : plan_world(empty_scene(), {}, true).stages)
    EXPECT_TRUE(stage.active) << stage.name;
}

TEST(Plan, DriverIsNamedByPrecision) {
  EXPECT_EQ(plan_world(empty_scene(), {}, false).driver, "world<double>");
  EXPECT_EQ(plan_world(empty_scene(), {.precision = Precision::Float}, false).driver, "world<float>");
}

// Stages that a plan leaves out make no difference to any bit.
TEST(Plan, DerivedAndEveryStageGiveTheSameBits) {
  Scene spinning = with(empty_scene(), {disc("a", {0, 0})});
  spinning.bodies[0].angular_velocity = -3;
  spinning.bodies[0].velocity = {-0.0, 2};
  const std::vector<Scene> scenes = {
      with(empty_scene(), {disc("a", {0, 0}), disc("b", {0, 3})}),
      spinning,
      pushed(spinning),
      dragged(spinning),
      with(empty_scene({0, 0}), {disc("a", {0, 0}, 0.5, 0, 1), disc("b", {3, 0}, 0.5, 0, 1)}),
      rotation_fixed(with(empty_scene(), {plane(), box("a", {0, 0.7}, 1, 1)})),
      with(empty_scene(), {plane(0), box("a", {0, 0.7}, 1, 1, 0), disc("b", {1, 2})}),
      rods(4),
      pile(27, 0.5),
      tower(12),
  };
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    for (const Integrator integrator :
         {Integrator::VelocityVerlet, Integrator::SemiImplicitEuler, Integrator::ExplicitEuler}) {
      for (const Precision precision : {Precision::Float, Precision::Double}) {
        for (const Solver solver : {Solver::SoftSteps, Solver::SequentialImpulses}) {
          Realtime accuracy = with_integrator(integrator);
          accuracy.precision = precision;
          accuracy.solver = solver;
          Simulation derived = compile(scenes[i], accuracy),
                     all = compile(scenes[i], accuracy, {.every_stage = true});
          derived.step(60);
          all.step(60);
          EXPECT_EQ(derived.hash(), all.hash())
              << i << " " << name_of(integrator) << " " << name_of(precision);
        }
      }
    }
  }
}

// A body is at rest by comparison with its size, which its shapes give, whether they can touch or not.
TEST(Plan, DerivedAndEveryStageFallAsleepInTheSameStep) {
  Scene swing = with(empty_scene({0, 0}), {box("a", {0, 0}, 1.6, 0.3)});
  RevoluteJoint hinge;
  hinge.name = "hinge", hinge.body_a = "world", hinge.body_b = "a";
  hinge.spring = Spring{0.16, 0}, hinge.target_angle = 0.4;
  swing.joints = {hinge};
  const Scene at_rest = with(empty_scene({0, 0}), {disc("a", {0, 0})});
  for (const Scene& scene : {swing, at_rest}) {
    for (const Precision precision : {Precision::Float, Precision::Double}) {
      Simulation derived = compile(scene, Realtime{.precision = precision, .sleeping = true}),
                 all = compile(scene, Realtime{.precision = precision, .sleeping = true},
                               {.every_stage = true});
      for (int i = 0; i < 60; ++i) {
        derived.step(), all.step();
        ASSERT_EQ(derived.hash(), all.hash()) << name_of(precision) << " step " << i;
      }
    }
  }
}

TEST(Plan, ProfilingTimesTheStagesThatRun) {
  Simulation world = compile(dragged(with(empty_scene(), {plane(), disc("a", {0, 0.5})})));
  world.step();
  for (const Stage& stage : world.plan().stages) EXPECT_EQ(stage.nanoseconds, 0);
  world.profile(true);
  world.step(50);
  for (const Stage& stage : world.plan().stages) {
    EXPECT_TRUE(!stage.active || stage.nanoseconds > 0) << stage.name;
  }
}

}  // namespace
}  // namespace plumb
