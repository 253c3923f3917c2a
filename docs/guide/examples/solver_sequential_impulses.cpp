// Sequential impulses: more iterations carry a load farther up a chain.
#include <algorithm>
#include <cstdio>

#include "engine/world/world.h"

// How far the joints of ten links with a tip of 20 kg come apart in the first second of their swing, m.
double worst_gap(int iterations) {
  using namespace plumb;
  World world({.solver = Solver::SequentialImpulses, .iterations = iterations});
  BodyId last = world.create_body({.type = BodyType::Static});
  for (int i = 0; i < 10; ++i) {
    const MassProperties mass{.mass = i == 9 ? 20.0 : 1.0, .inertia = 1.0 / 12};
    const BodyId link = world.create_body({.position = {0.5 + i, 0}, .mass = mass});
    world.create_joint(
        last, link, {.kind = RevoluteDefinition{.anchor_a = {i == 0 ? 0 : 0.5, 0}, .anchor_b = {-0.5, 0}}});
    last = link;
  }
  double worst = 0;
  for (int i = 0; i < 60; ++i) {
    world.step();
    for (const BodyId body : world.bodies())
      for (const JointId joint : world.joints(body)) worst = std::max(worst, world.read(joint).linear_error);
  }
  return worst;
}

int main() {
  for (const int iterations : {1, 4, 16, 64})
    std::printf("%2d iterations: joints come apart by %.1f mm\n", iterations, 1000 * worst_gap(iterations));
  return worst_gap(16) < worst_gap(1) ? 0 : 1;
}
