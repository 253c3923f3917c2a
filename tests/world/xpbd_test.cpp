#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/world/solver_scenes.h"

// Checks what is particular to XPBD: compliance means the same whatever the step, and substeps are its
// sweeps.
namespace plumb {
namespace {

using test::add_hook;
using test::add_mass;
using test::with;

// At rest a spring of stiffness k = m (2 pi f)^2 stretches by m g / k, exactly, with any substep.
TEST(Xpbd, ComplianceTimesForceIsTheStretchAtRest) {
  for (const int substeps : {1, 4, 20}) {
    for (const double hertz : {0.5, 2.0, 8.0}) {
      DoubleWorld world(with(Solver::Xpbd));
      const double mass = 3, k = mass * std::pow(2 * test::kPi * hertz, 2);
      const BodyId body = add_mass(world, {0, -1}, mass, 1);
      const JointId spring = world.create_joint(
          add_hook(world), body, {.kind = DistanceDefinition{.length = 1, .spring = Spring{hertz, 1}}});
      run(world, 900, 1.0 / 60, substeps);
      EXPECT_NEAR(world.read(spring).length, 1 + mass * kGravity / k, 1e-9) << substeps << ' ' << hertz;
      EXPECT_NEAR(world.read(spring).force, mass * kGravity, 1e-9);
    }
  }
}

// Undamped at 1 Hz: implicit Euler's (1 + (w h)^2)^(-1/2) a substep is all that it loses.
TEST(Xpbd, ASpringSwingsAtItsFrequency) {
  DoubleWorld world(test::weightless(Solver::Xpbd));
  const BodyId body = add_mass(world, {0, -1.5}, 2, 1);
  world.create_joint(add_hook(world), body,
                     {.kind = DistanceDefinition{.length = 1, .spring = Spring{1, 0}}});
  const double dt = 1.0 / 240, h = dt / 20, w = 2 * test::kPi;
  run(world, 240, dt, 20);
  EXPECT_NEAR(world.position(body).y, -1 - 0.5 * std::pow(1 + w * w * h * h, -0.5 / h), 1e-4);
}

// The error of a swinging chain falls with the square of the substep.
TEST(Xpbd, MoreSubstepsStretchAChainLess) {
  double before = 1e9;
  for (const int substeps : {4, 8, 16, 32}) {
    DoubleWorld world(with(Solver::Xpbd));
    const test::Chain chain = test::add_chain(world, 10);
    const double gap = test::run_gap(world, chain.joints, 60, 1.0 / 60, substeps);
    EXPECT_LT(gap, before / 3) << substeps;
    before = gap;
  }
}

// The speed that an overlap is pushed out with is taken back: no burst.
TEST(Xpbd, OverlapsDissolveWithoutABurst) {
  World world(test::weightless(Solver::Xpbd));
  const BodyId a = add_box(world, {0, 0}), b = add_box(world, {0.9, 0});
  double fastest = 0;
  for (int i = 0; i < 60; ++i) {
    world.step();
    fastest = std::max(fastest, world.velocity(b).x);
  }
  EXPECT_NEAR(world.position(b).x - world.position(a).x, 1, 1e-4);
  EXPECT_NEAR(fastest, 0, 1e-5);
}

}  // namespace
}  // namespace plumb
