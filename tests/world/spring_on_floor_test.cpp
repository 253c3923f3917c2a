#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "engine/world/add_scene.h"
#include "engine/world/force_laws.h"
#include "engine/world/scene/scene_forces.h"
#include "engine/world/world.h"

namespace plumb {
namespace {

constexpr Solver kSolvers[] = {Solver::SoftSteps, Solver::SequentialImpulses, Solver::Jakobsen, Solver::Xpbd,
                               Solver::Direct};

// 1 kg on a spring of 100 N/m: omega = 10 rad/s.
constexpr double kStiffness = 100, kOmega = 10;

// A box on a spring, on a frictionless floor or on a tile of one that it slides off and on.
Scene box_on_a_spring() {
  Scene scene;
  scene.gravity = {0, -10};
  Body floor{.name = "floor", .type = BodyType::Static, .position = {0, -0.5}};
  floor.shapes = {Shape{.geometry = Box{20, 1}, .friction = 0}};
  Body box{.name = "box", .position = {1, 0.1}};
  box.mass = 1;
  box.fixed_rotation = true;
  box.shapes = {Shape{.geometry = Box{0.2, 0.2}, .friction = 0}};
  scene.bodies = {floor, box};
  SpringForce spring;
  spring.body_a = "world", spring.body_b = "box";
  spring.anchor_a = {-10, 0.1};
  spring.stiffness = kStiffness, spring.rest_length = 10;
  scene.forces = {spring};
  return scene;
}

// The energy as a share of that at the start, at its least and most.
struct Range {
  double least = 1, most = 1;
  void add(double x, double v) {
    const double energy = (v * v + kOmega * kOmega * x * x) / (kOmega * kOmega);
    least = std::min(least, energy), most = std::max(most, energy);
  }
};

// A step of n substeps kicks at one end of each and drifts at the other: the energy swings by omega h / 2,
// and by (omega dt)^2 / 4 as that of any method that takes forces once a step. Its mean stays. A tenth for
// terms of higher order.
double swing(double dt, int substeps) {
  const double half = 0.5 * kOmega * dt / substeps;
  return 1.1 * (half + kOmega * dt * kOmega * dt / 4) / (1 - half);
}

template <class Real>
void expect_energy_of_scene_kept(Solver solver, double dt, int substeps) {
  const Scene scene = box_on_a_spring();
  BasicWorld<Real> world({.gravity = scene.gravity, .sleeping = false, .solver = solver});
  const SceneParts parts = add_scene(world, scene);
  SceneForces<Real> forces(scene, parts);
  Range range;
  const int periods = 10;
  for (int i = 0; i < static_cast<int>(periods * 2 * 3.14159265 / kOmega / dt); ++i) {
    forces.apply(world, dt);
    world.step(dt, substeps);
    const BodyState state = world.state(parts.bodies[1]);
    range.add(state.position.x, state.velocity.x);
  }
  EXPECT_GT(range.least, 1 - swing(dt, substeps)) << name_of(solver) << " " << dt << " " << substeps;
  EXPECT_LT(range.most, 1 + swing(dt, substeps)) << name_of(solver) << " " << dt << " " << substeps;
}

TEST(SpringOnAFloor, OfASceneKeepsItsEnergyInEverySolver) {
  for (const Solver solver : kSolvers) {
    for (const int substeps : {1, 4, 8}) {
      for (const double rate : {30.0, 60.0, 240.0}) {
        expect_energy_of_scene_kept<float>(solver, 1 / rate, substeps);
        expect_energy_of_scene_kept<double>(solver, 1 / rate, substeps);
      }
    }
  }
}

TEST(SpringOnAFloor, ThatIsAppliedKeepsItsEnergy) {
  constexpr double kDt = 1.0 / 60;
  for (const Solver solver : kSolvers) {
    DoubleWorld world({.sleeping = false, .solver = solver});
    const Material smooth{.friction = 0};
    const BodyId ground = world.create_body({.type = BodyType::Static, .position = {0, -0.5}},
                                            {.geometry = Box{40, 1}, .material = smooth});
    const BodyId box = world.create_body({.position = {1, 0.1}, .lock_rotation = true},
                                         {.geometry = Box{0.2, 0.2}, .density = 25, .material = smooth});
    ASSERT_NEAR(world.mass(box), 1, 1e-12);
    Range range;
    for (int i = 0; i < 377; ++i) {
      apply_spring(world, ground, {-10, 0.6}, box, {0, 0}, {.stiffness = kStiffness, .rest_length = 10}, kDt);
      world.step(kDt);
      range.add(world.position(box).x, world.velocity(box).x);
    }
    EXPECT_GT(range.least, 1 - swing(kDt, 4)) << name_of(solver);
    EXPECT_LT(range.most, 1 + swing(kDt, 4)) << name_of(solver);
  }
}

}  // namespace
}  // namespace plumb
