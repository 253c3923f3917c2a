// Jakobsen's projections: a rope of masses and rods that wraps around a peg.
#include <cstdio>
#include <vector>

#include "engine/world/world.h"

int main() {
  using namespace plumb;
  World world({.solver = Solver::Jakobsen, .iterations = 10});
  world.create_body({.type = BodyType::Static, .position = {1, -1}}, {.geometry = Circle{0.3}});
  const double pitch = 0.15;
  BodyId last = world.create_body({.type = BodyType::Static});
  std::vector<JointId> rods;
  for (int i = 1; i <= 20; ++i) {
    const BodyId bead = world.create_body({.position = {pitch * i, 0}}, {.geometry = Circle{0.05}});
    rods.push_back(world.create_joint(last, bead, {.kind = DistanceDefinition{.length = pitch}}));
    last = bead;
  }
  for (int i = 0; i < 600; ++i) world.step(1.0 / 60, 4);
  double length = 0;
  for (const JointId rod : rods) length += world.read(rod).length;
  std::printf("a rope of 3 m is %.3f m long, its end hangs at (%.2f, %.2f) m\n", length,
              world.position(last).x, world.position(last).y);
  return length < 3.01 ? 0 : 1;
}
