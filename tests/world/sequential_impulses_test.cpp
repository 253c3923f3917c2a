#include <gtest/gtest.h>

#include <cmath>

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

// A beam of welded planks held at one end: the slowest mode of the iterations is slower, the more planks
// there are. If the feedback of errors were part of the impulses that the next substep starts from, it would
// grow without end (engine/world/solvers/error_feedback.h): beams of three planks and more flew off at 1e9
// m/s.
TEST(SequentialImpulses, ABeamOfPlanksNeverGainsEnergyHoweverFewTheIterations) {
  constexpr double kMass = 100, kInertia = kMass * (1 + 0.1 * 0.1) / 12;
  for (const int iterations : {1, 4, 10}) {
    for (const int count : {2, 3, 5, 8}) {
      for (const bool weld : {true, false}) {
        DoubleWorld world(with(Solver::SequentialImpulses, iterations));
        std::vector<BodyId> planks;
        BodyId before = world.create_body({.type = BodyType::Static});
        for (int i = 0; i < count; ++i) {
          const BodyId plank =
              world.create_body({.position = {0.5 + i, 0}}, {.geometry = Box{1, 0.1}, .density = 1000});
          const Vec2d end{i == 0 ? 0.0 : 0.5, 0}, start{-0.5, 0};
          if (weld) {
            world.create_joint(before, plank, {.kind = WeldDefinition{.anchor_a = end, .anchor_b = start}});
          } else {
            world.create_joint(
                before, plank,
                {.kind = RevoluteDefinition{.anchor_a = end, .anchor_b = start, .limits = Range{0, 0}}});
          }
          planks.push_back(before = plank);
        }
        // Relative to the energy of the whole beam hanging down.
        const double scale = kMass * 9.81 * count * count / 2;
        for (int step = 0; step < 300; ++step) {
          world.step(1.0 / 60);
          double energy = 0;
          for (const BodyId plank : planks) {
            const Vec2d v = world.velocity(plank);
            const double w = world.angular_velocity(plank);
            energy += kMass * (9.81 * world.position(plank).y + dot(v, v) / 2) + kInertia * w * w / 2;
          }
          ASSERT_LT(energy, 1e-12 * scale) << iterations << ' ' << count << ' ' << weld << ' ' << step;
        }
        if (iterations == 10 && count <= 3) {
          EXPECT_LT(std::abs(world.position(planks.back()).y), 1e-9);
        }
      }
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
