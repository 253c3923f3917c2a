#include "scenarios/truth/parts.h"

// A heavy box on a light one: it rests, whatever the ratio. Source: statics.
namespace plumb::scenarios::high_mass_ratio {
namespace {
using namespace truth;

Problem build(std::string_view variant, int) {
  const double ratio = choose(variant, {{"10", 10}, {"1000", 1000}, {"1e6", 1e6}});
  Problem problem{.scene = scene_of("high_mass_ratio", variant), .duration = 1};
  problem.scene.bodies = {ground(0.5), piece("light", {0, 0.25}, solid(Box{0.5, 0.5}, 0.5)),
                          piece("heavy", {0, 1}, solid(Box{1, 1}, 0.5), ratio)};
  problem.truth = equilibrium(problem.scene, "the light box carries the heavy one (statics)");
  problem.conserved = {.energy = true};
  problem.precise = within(1e-9);
  return problem;
}

const Register r{{.name = "high_mass_ratio",
                  .summary = "a heavy box on a light one",
                  .variants = {"10", "1000", "1e6"},
                  .build = build}};

}  // namespace
}  // namespace plumb::scenarios::high_mass_ratio
