#include "tests/properties/runs.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "engine/simulation/simulation.h"
#include "engine/world/scene/scene_forces.h"

namespace plumb::properties {
namespace {

template <class Real>
States run_world(const Scene& scene, const Steps& steps) {
  WorldDefinition definition = world_definition(scene);
  // Both ask for speeds relative to the world's frame.
  definition.sleeping = false;
  definition.continuous = steps.continuous;
  BasicWorld<Real> world(definition);
  const SceneParts parts = add_scene(world, scene);
  SceneForces<Real> forces(scene, parts);
  for (int i = 0; i < steps.count; ++i) {
    forces.apply(world, steps.dt);
    world.step(steps.dt);
  }
  States states;
  for (const BodyId body : parts.bodies) states.push_back(world.state(body));
  return states;
}

States run_simulation(const Scene& scene, const Accuracy& accuracy, int count) {
  Simulation simulation = compile(scene, accuracy);
  simulation.step(count);
  States states(scene.bodies.size());
  simulation.read(states);
  return states;
}

/// A force that changes the velocity by a tenth of `by` in a step, every step by another share: what rounds
/// as the motion goes on. It parts what a disturbance of the start alone leaves equal, as contacts make zeros
/// anew.
template <class Some>
SinusoidalForce shaking(const Body& body, double by, double dt, const Some& some) {
  SinusoidalForce force{.body = body.name};
  const double x = some(), y = some(), turn = some();
  force.amplitude = (0.1 * by * body.mass / dt) * Vec2d{x, y};
  force.point = {0.1 * turn, -0.1 * turn};
  force.angular_frequency = (1.7 + 0.3 * some()) / dt;
  force.phase = 3 * some();
  return force;
}

}  // namespace

std::string name_of(Engine engine) {
  switch (engine) {
    case Engine::Precise:
      return "Precise";
    case Engine::World:
      return "World";
    case Engine::DoubleWorld:
      return "DoubleWorld";
  }
  return "";
}

States run(Engine engine, const Scene& scene, const Steps& steps) {
  switch (engine) {
    case Engine::Precise:
      return run_simulation(scene, Precise{.tolerance = 1e-10, .max_dt = steps.dt}, steps.count);
    case Engine::World:
      return run_world<float>(scene, steps);
    case Engine::DoubleWorld:
      return run_world<double>(scene, steps);
  }
  return {};
}

double difference(const States& a, const States& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (const double each :
         {a[i].position.x - b[i].position.x, a[i].position.y - b[i].position.y, a[i].angle - b[i].angle,
          a[i].velocity.x - b[i].velocity.x, a[i].velocity.y - b[i].velocity.y,
          a[i].angular_velocity - b[i].angular_velocity})
      most = std::max(most, std::abs(each));
  }
  return most;
}

double disturbance(Engine engine) {
  if (engine == Engine::Precise) return 1e-9;
  return engine == Engine::World ? 1e3 * 0x1p-24 : 1e4 * 0x1p-53;
}

double sensitivity(Engine engine, const Scene& scene, const States& end, double by, const Steps& steps,
                   unsigned first, unsigned count) {
  double most = by;
  for (unsigned seed = first; seed < first + count; ++seed) {
    std::mt19937 random(seed);
    const auto some = [&] { return 2 * (static_cast<double>(random()) / 4294967295.0) - 1; };
    Scene disturbed = scene;
    for (const Body& body : scene.bodies) {
      if (body.type == BodyType::Static) continue;
      Body& other = disturbed.bodies[static_cast<std::size_t>(&body - scene.bodies.data())];
      for (double* number : {&other.position.x, &other.position.y, &other.angle, &other.velocity.x,
                             &other.velocity.y, &other.angular_velocity})
        *number += by * some();
      if (engine != Engine::Precise) disturbed.forces.push_back(shaking(body, by, steps.dt, some));
    }
    most = std::max(most, difference(run(engine, disturbed, steps), end));
  }
  return most;
}

}  // namespace plumb::properties
