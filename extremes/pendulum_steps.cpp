#include "extremes/parts/swing.h"

#include "extremes/parts/scenes.h"

namespace plumb::extremes {
namespace {

constexpr double kLength = 10, kAngle = std::numbers::pi / 2;

Trial build(double steps) {
  Trial trial{.scene = pendulum("pendulum_steps", kLength, kAngle),
              .stretches = evenly(static_cast<long>(steps), 1000)};
  trial.exact = swinging(kLength, kAngle);
  trial.judge = [](const Scene& scene) {
    const double energy = swing_energy(kLength, kAngle);
    return judge_by({energy_gained(scene, energy, 0.01), energy_lost(scene, energy, 0.01),
                     sum_of_gaps(scene, kLength / 100, 10 * kLength)});
  };
  return trial;
}

const Register r{
    {.name = "pendulum_steps",
     .title = "a rod of 10 m swings at 90 degrees",
     .axis = "steps",
     .values = {1e3, 1e4, 1e5, 1e6, 1e7},
     .usual = 1e3,
     .rule = "energy error at most 1 % of the energy of the swing, joint gap at most 1 % of the rod's length",
     .patience = 3,
     .build = build}};

}  // namespace
}  // namespace plumb::extremes
