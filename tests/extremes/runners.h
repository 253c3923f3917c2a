#pragma once

#include <memory>
#include <string>
#include <utility>

#include "engine/simulation/simulation.h"
#include "engine/world/scene/scene_forces.h"

/// The engines that extremes are asked of, behind one face.
namespace plumb::test {

class Runner {
 public:
  virtual ~Runner() = default;
  virtual void step() = 0;
  virtual BodyState state(std::size_t body) const = 0;
};

template <class Real>
class WorldRunner final : public Runner {
 public:
  WorldRunner(const Scene& scene, double dt, int substeps, WorldDefinition definition)
      : dt_(dt),
        substeps_(substeps),
        world_(adapted(scene, definition)),
        parts_(add_scene(world_, scene)),
        forces_(scene, parts_) {}
  void step() override {
    forces_.apply(world_, dt_);
    world_.step(dt_, substeps_);
  }
  BodyState state(std::size_t body) const override { return world_.state(parts_.bodies[body]); }

 private:
  static WorldDefinition adapted(const Scene& scene, WorldDefinition definition) {
    const WorldDefinition own = world_definition(scene);
    definition.gravity = own.gravity;
    definition.combine_friction = own.combine_friction;
    definition.combine_restitution = own.combine_restitution;
    return definition;
  }
  double dt_;
  int substeps_;
  BasicWorld<Real> world_;
  SceneParts parts_;
  SceneForces<Real> forces_;
};

class SimulationRunner final : public Runner {
 public:
  SimulationRunner(const Scene& scene, const Accuracy& accuracy) : simulation_(compile(scene, accuracy)) {}
  void step() override { simulation_.step(); }
  BodyState state(std::size_t body) const override { return simulation_.state(body); }

 private:
  Simulation simulation_;
};

/// World in float and double, and Precise.
enum class Engine { World, DoubleWorld, Precise };

inline std::string name_of(Engine engine) {
  return engine == Engine::World ? "world" : engine == Engine::DoubleWorld ? "double_world" : "precise";
}

/// With defaults, in steps of `dt`. Bodies do not sleep: what creeps is to be seen.
inline std::unique_ptr<Runner> make_runner(Engine engine, const Scene& scene, double dt = 1.0 / 60,
                                           double tolerance = 1e-9) {
  const WorldDefinition awake{.sleeping = false, .quarantine = false};
  switch (engine) {
    case Engine::World:
      return std::make_unique<WorldRunner<float>>(scene, dt, 4, awake);
    case Engine::DoubleWorld:
      return std::make_unique<WorldRunner<double>>(scene, dt, 4, awake);
    case Engine::Precise:
      break;
  }
  return std::make_unique<SimulationRunner>(scene, Precise{.tolerance = tolerance, .max_dt = dt});
}

}  // namespace plumb::test
