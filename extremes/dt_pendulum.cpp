#include <algorithm>

#include "extremes/parts/scenes.h"
#include "extremes/parts/swing.h"

namespace plumb::extremes {
namespace {

constexpr double kAngle = std::numbers::pi / 3;
constexpr long kLeast = 100, kMost = 200'000;  // steps

Trial build(double dt) {
  Trial trial{.scene = pendulum("dt_pendulum", 1, kAngle), .dt = dt};
  const long steps = std::clamp(steps_for(5, dt), kLeast, kMost);
  trial.stretches = evenly(steps, 200);
  trial.exact = swinging(1, kAngle);
  trial.judge = [exact = trial.exact](const Scene& scene) {
    const double energy = swing_energy(1, kAngle);
    return judge_by({sum_of_gaps(scene, 0.01, 10), energy_gained(scene, energy, 0.05),
                     energy_lost(scene, energy, 0.05), path_not_covered(scene, exact, 0.02)});
  };
  return trial;
}

const Register r{
    {.name = "dt_pendulum",
     .title = "a rod of 1 m swings at 60 degrees for 5 s, at least 100 steps and at most 200,000",
     .axis = "dt",
     .unit = "s",
     .values = {1e-6, 1e-5, 1e-4, 1e-3, 1.0 / 60, 0.05, 0.2, 1},
     .usual = 1.0 / 60,
     .rule = "joint gap at most 1 % of the rod's length, energy error at most 5 % of the energy of the "
             "swing, at least half of the path covered",
     .build = build}};

}  // namespace
}  // namespace plumb::extremes
