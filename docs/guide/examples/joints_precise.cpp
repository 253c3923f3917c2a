// The same joint in a game's world and in Precise: two masses on a rope over pulleys (Atwood, 1784).
#include <cmath>
#include <cstdio>

#include "engine/simulation/simulation.h"
#include "engine/world/add_scene.h"

int main() {
  using namespace plumb;
  Scene scene;
  const auto weight = [&](const char* name, double x, double kilograms) {
    scene.bodies.push_back({.name = name, .position = {x, 0}, .mass = kilograms, .inertia = 1.0});
  };
  weight("heavy", -1, 3), weight("light", 1, 2);
  scene.joints.push_back(PulleyJoint{
      .name = "rope", .body_a = "heavy", .body_b = "light", .ground_a = {-1, 5}, .ground_b = {1, 5}});
  const double exact = -0.5 * 9.81 * (3.0 - 2.0) / (3.0 + 2.0);  // m after 1 s

  World world(world_definition(scene));
  const SceneParts parts = add_scene(world, scene);
  for (int i = 0; i < 60; ++i) world.step(1.0 / 60);

  Simulation precise = compile(scene, Precise{.tolerance = 1e-9});
  precise.step(60);

  const double of_world = world.position(parts.bodies[0]).y, of_precise = precise.state(0).position.y;
  std::printf("exact %.6f m; World %.6f m, Precise %.6f m\n", exact, of_world, of_precise);
  std::printf("Precise is within its tolerance: %s\n", std::abs(of_precise - exact) < 1e-9 ? "yes" : "no");
  scene.joints.push_back(RatchetJoint{.name = "click", .body_a = "heavy", .body_b = "light", .tooth = 0.1});
  std::printf("Precise says: %s\n", unsupported(scene, Precise{}).c_str());
  return std::abs(of_precise - exact) < 1e-9 ? 0 : 1;
}
