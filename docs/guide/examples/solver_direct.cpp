// The direct solve: sixteen links and a tip of five swing, and do not stretch.
#include <algorithm>
#include <cstdio>
#include <vector>

#include "engine/world/world.h"

int main() {
  using namespace plumb;
  for (const Solver solver : {Solver::SoftSteps, Solver::Direct}) {
    World world({.solver = solver});
    BodyId last = world.create_body({.type = BodyType::Static});
    std::vector<JointId> joints;
    for (int i = 0; i < 16; ++i) {
      const double kg = i == 15 ? 5 : 1;
      const BodyId link = world.create_body(
          {.position = {0.05 + 0.1 * i, 0}, .mass = MassProperties{.mass = kg, .inertia = kg / 1200}});
      joints.push_back(world.create_joint(
          last, link,
          {.kind = RevoluteDefinition{.anchor_a = {i == 0 ? 0 : 0.05, 0}, .anchor_b = {-0.05, 0}}}));
      last = link;
    }
    double worst = 0;
    for (int i = 0; i < 300; ++i) {
      world.step();
      for (const JointId joint : joints) worst = std::max(worst, world.read(joint).linear_error);
    }
    std::printf("%s: joints come apart by up to %.3f mm\n", name_of(solver), 1000 * worst);
  }
  return 0;
}
