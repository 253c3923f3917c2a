#include <gtest/gtest.h>

#include "tests/world/solver_scenes.h"

// Checks what is particular to sequential impulses: the gap that Baumgarte's feedback leaves, and the use of
// sweeps.
namespace plumb {
namespace {

using test::add_hook;
using test::add_mass;
using test::with;

constexpr double kFeedback = 0.2;

// On a circle at constant speed each substep drifts by h^2 v^2 / (2 L) and takes back a fifth of what has
// come together: C = drift / 0.2, and the feedback's own way outwards is of higher order.
TEST(SequentialImpulses, ARodStretchesByBaumgartesLaw) {
  for (const double speed : {1.0, 2.0, 4.0}) {
    for (const int substeps : {1, 4}) {
      DoubleWorld world(test::weightless(Solver::SequentialImpulses));
      const BodyId mass = add_mass(world, {1, 0}, 1, 1, {0, speed});
      const JointId rod =
          world.create_joint(add_hook(world), mass, {.kind = DistanceDefinition{.length = 1}});
      run(world, 120, 1.0 / 60, substeps);
      const double h = 1.0 / 60 / substeps, law = test::tangent_drift(speed, 1, h) / kFeedback;
      EXPECT_NEAR(world.read(rod).linear_error, law, 0.05 * law) << speed << ' ' << substeps;
    }
  }
}

// A heavy tip on light links: each sweep carries the load up by a link or so.
TEST(SequentialImpulses, MoreSweepsStretchAChainLess) {
  double before = 1e9;
  for (const int iterations : {2, 4, 8, 16, 32, 64}) {
    DoubleWorld world(with(Solver::SequentialImpulses, iterations));
    const test::Chain chain = test::add_chain(world, 10, 20);
    run(world, 60);
    const double gap = test::worst_gap(world, chain.joints);
    EXPECT_LT(gap, before) << iterations;
    before = gap;
  }
}

// Impulses of the step before are where sweeps start from: one sweep a step holds a tower.
TEST(SequentialImpulses, WarmStartingHoldsATowerWithOneSweep) {
  World world(with(Solver::SequentialImpulses, 1));
  add_ground(world);
  BodyId top{};
  for (int i = 0; i < 8; ++i) top = add_box(world, {0, 0.5 + i});
  run(world, 600);
  // Each contact may keep its slop: 0.002 of half a box's diagonal.
  EXPECT_NEAR(world.position(top).y, 7.5, 8 * 0.002 * std::sqrt(0.5));
}

}  // namespace
}  // namespace plumb
