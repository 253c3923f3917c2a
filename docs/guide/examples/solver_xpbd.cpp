// XPBD: a spring's stiffness does not depend on the step, and substeps take the place of iterations.
#include <cmath>
#include <cstdio>

#include "engine/world/world.h"

int main() {
  using namespace plumb;
  const double hertz = 1.5, mass = 2, stiffness = mass * std::pow(2 * 3.14159265358979 * hertz, 2);
  std::printf("%.2f kg on %.1f N/m stretch it by %.4f m\n", mass, stiffness, mass * 9.81 / stiffness);
  for (const int substeps : {1, 5, 20}) {
    World world({.solver = Solver::Xpbd});
    const BodyId hook = world.create_body({.type = BodyType::Static});
    const BodyId weight = world.create_body(
        {.position = {0, -1}, .mass = MassProperties{.mass = mass, .inertia = 1}, .may_sleep = false});
    const JointId spring = world.create_joint(
        hook, weight, {.kind = DistanceDefinition{.length = 1, .spring = Spring{hertz, 1}}});
    for (int i = 0; i < 600; ++i) world.step(1.0 / 60, substeps);
    std::printf("%2d substeps: %.4f m\n", substeps, world.read(spring).length - 1);
  }
  return 0;
}
