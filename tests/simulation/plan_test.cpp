#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "engine/realtime/stages.h"
#include "tests/simulation/scenes.h"

namespace plumb {
namespace {

using namespace plumb::testing;

std::string active_stages(const Scene& scene, const Realtime& accuracy = {}) {
  std::string out;
  const Plan plan = plan_realtime(scene, accuracy, false);
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
  const Scene bouncing = with(empty_scene(), {disc("a", {0, 0}, 0.5, 0, 1), disc("b", {3, 0}, 0.5, 0, 1)});
  const Scene rubbing = with(empty_scene(), {plane(), box("a", {0, 0.5}, 1, 1)});
  Scene spinning = one;
  spinning.bodies[0].angular_velocity = 1;
  Scene excluded = two;
  excluded.joints = {DistanceJoint{"bar", "a", "b", {}, {}, 3}};
  const Scene plates =
      with(empty_scene(), {plane(), fixed(box("b", {0, 3}, 1, 1)), fixed(box("c", {0, 3}, 1, 1))});

  const struct {
    const char* what;
    Scene scene;
    const char* stages;
  } table[] = {
      {"one disc", one, "kick drift check watch"},
      {"it spins", spinning, "kick drift turn check watch"},
      {"with drag", dragged(one), "forces kick drift check watch"},
      {"pushed off its centre", pushed(one), "forces kick drift turn check watch"},
      {"pushed, but cannot turn", rotation_fixed(pushed(one)), "forces kick drift check watch"},
      {"two discs", two,
       "broad_phase narrow_phase kick contact_hold drift turn push_out contact_relax check watch"},
      {"they bounce", bouncing,
       "broad_phase narrow_phase kick restitution contact_hold drift turn push_out contact_relax check "
       "watch"},
      {"a filter keeps them apart", never_touching(bouncing), "kick drift check watch"},
      {"a joint keeps them apart", excluded, "kick joint_hold drift turn joint_relax check watch"},
      {"friction", rubbing,
       "broad_phase narrow_phase kick contact_hold drift turn push_out contact_relax friction check watch"},
      {"nothing can turn", rotation_fixed(rubbing),
       "broad_phase narrow_phase kick contact_hold drift push_out contact_relax friction check watch"},
      {"nothing can move", plates, "kick drift check watch"},
      {"rods", rods(3), "kick joint_hold drift turn joint_relax check watch"},
  };
  for (const auto& row : table) EXPECT_EQ(active_stages(row.scene), row.stages) << row.what;
  EXPECT_EQ(active_stages(rods(3), with_integrator(Integrator::SemiImplicitEuler)),
            "kick joint_hold drift turn check");
}

// Restitution of one kind of pair that cannot touch does not count.
TEST(Plan, OnlyPairsThatCanTouchDecide) {
  Scene scene = with(empty_scene(), {plane(0, 0), disc("a", {0, 2}), disc("ghost", {0, 4}, 0.5, 1, 1)});
  scene.bodies[2].shapes[0].filter.mask = 0;
  EXPECT_EQ(active_stages(scene),
            "broad_phase narrow_phase kick contact_hold drift turn push_out contact_relax check watch");
}

TEST(Plan, EveryStageIsActiveOnRequest) {
  for (const Stage& stage : plan_realtime(empty_scene(), {}, true).stages)
    EXPECT_TRUE(stage.active) << stage.name;
}

TEST(Plan, DriverIsNamedByPrecision) {
  EXPECT_EQ(plan_realtime(empty_scene(), {}, false).driver, "realtime<double>");
  EXPECT_EQ(plan_realtime(empty_scene(), {.precision = Precision::Float}, false).driver, "realtime<float>");
}

// What a plan leaves out makes no difference to any bit.
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
        for (const JointSolver solver : {JointSolver::Direct, JointSolver::Iterative}) {
          Realtime accuracy = with_integrator(integrator);
          accuracy.on_doubt = OnDoubt::Report;  // the bits matter, not how right they are
          accuracy.precision = precision;
          accuracy.joint_solver = solver;
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

TEST(Plan, SettingABodySpinningAddsTheStage) {
  Simulation world = compile(with(empty_scene(), {disc("a", {0, 0})}));
  BodyState state = world.state(0);
  state.angular_velocity = 2;
  world.set_state(0, state);
  EXPECT_TRUE(is_active(world.plan(), RealtimeStage::Turn));
  world.step(60);
  EXPECT_NEAR(world.state(0).angle, 2, 1e-13);
}

TEST(Plan, ProfilingTimesWhatRuns) {
  Simulation world = compile(rods(5));
  world.step();
  for (const Stage& stage : world.plan().stages) EXPECT_EQ(stage.nanoseconds, 0);
  world.profile(true);
  world.step(5);
  for (const Stage& stage : world.plan().stages) EXPECT_EQ(stage.nanoseconds > 0, stage.active) << stage.name;
}

}  // namespace
}  // namespace plumb
