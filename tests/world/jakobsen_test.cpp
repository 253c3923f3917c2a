#include <gtest/gtest.h>

#include <cmath>

#include "tests/world/solver_scenes.h"

// Checks what is particular to Jakobsen's projections: they end where constraints hold, and more sweeps hold
// more.
namespace plumb {
namespace {

using test::add_hook;
using test::add_mass;
using test::with;

// One constraint is projected where it holds; velocities lose what the projection takes: the tangent's
// cos(atan(h v / L)) each substep.
TEST(Jakobsen, ARodDoesNotStretchAndLosesSpeed) {
  const double speed = 4;
  DoubleWorld world(test::weightless(Solver::Jakobsen));
  const BodyId mass = add_mass(world, {1, 0}, 1, 1, {0, speed});
  const JointId rod = world.create_joint(add_hook(world), mass, {.kind = DistanceDefinition{.length = 1}});
  EXPECT_LT(test::run_gap(world, {rod}, 60), 1e-12);
  const Vec2d v = world.velocity(mass);
  double expected = speed;
  const double h = 1.0 / 240;
  // The chord from one point of the circle to the next is the new velocity; the tangent at its end is what
  // the next substep starts with: x' = (x + h v) / |x + h v|, v' = (x' - x) / h.
  Vec2d x{1, 0}, u{0, speed};
  for (int i = 0; i < 240; ++i) {
    const Vec2d ahead = x + h * u, to = (1 / std::sqrt(length_squared(ahead))) * ahead;
    u = (1 / h) * (to - x);
    x = to;
  }
  expected = std::sqrt(length_squared(u));
  EXPECT_NEAR(std::sqrt(length_squared(v)), expected, 1e-9);
  EXPECT_LT(expected, speed);
}

TEST(Jakobsen, MoreSweepsStretchAChainLess) {
  double before = 1e9;
  for (const int iterations : {2, 5, 10, 20, 40}) {
    DoubleWorld world(with(Solver::Jakobsen, iterations));
    const test::Chain chain = test::add_chain(world, 10);
    const double gap = test::run_gap(world, chain.joints, 60);
    EXPECT_LT(gap, before) << iterations;
    before = gap;
  }
}

// Two masses that a rod ties give way by their inverse masses.
TEST(Jakobsen, ProjectionsAreWeightedByMass) {
  DoubleWorld world(test::weightless(Solver::Jakobsen));
  const BodyId light = add_mass(world, {0, 0}, 1, 1), heavy = add_mass(world, {2, 0}, 3, 1);
  world.create_joint(light, heavy, {.kind = DistanceDefinition{.length = 1}});
  world.step(1.0 / 60, 1);
  EXPECT_NEAR(world.position(light).x, 0.75, 1e-12);
  EXPECT_NEAR(world.position(heavy).x, 1.75, 1e-12);
}

}  // namespace
}  // namespace plumb
