#pragma once

#include <string>
#include <utility>
#include <vector>

#include "engine/simulation/simulation.h"

/// Scenes of point masses without gravity, and their motion.
namespace plumb {

constexpr double kDt = 1.0 / 60;

inline std::vector<BodyState> run(const Scene& scene, const Accuracy& accuracy, int steps) {
  Simulation simulation = compile(scene, accuracy);
  simulation.step(steps);
  std::vector<BodyState> states(scene.bodies.size());
  simulation.read(states);
  return states;
}

inline Body mass_point(const char* name, double mass, Vec2d position, Vec2d velocity = {}) {
  return {.name = name, .position = position, .velocity = velocity, .mass = mass, .inertia = 1};
}

inline Scene weightless(std::vector<Body> bodies, std::vector<ForceLaw> forces) {
  return {.name = "weightless", .gravity = {0, 0}, .bodies = std::move(bodies), .forces = std::move(forces)};
}

}  // namespace plumb
