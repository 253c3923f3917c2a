#include <numbers>

#include "scenarios/truth/bob_chain.h"
#include "scenarios/truth/parts.h"

// Point masses on massless rods, one below the other, let go from the horizontal: equal ones, and a tip that
// is heavier or lighter than the link above it. Source: Lagrange; `BobChain`.
namespace plumb::scenarios {
namespace {
using namespace truth;

Problem build(std::string_view variant, int) {
  const double ratio = choose(variant, {{"equal", 1}, {"heavy_tip", 100}, {"light_tip", 0.01}});
  const double level = std::numbers::pi / 2;
  const BobChain chain{{1, ratio}, {level, level}};
  Problem problem{.scene = chain.scene(scene_of("double_pendulum", variant)), .duration = 1.5};
  problem.truth = chain.truth(problem.scene);
  problem.conserved = {.energy = true};
  // Errors grow while a light tip whips round.
  problem.precise = within(1e-7);
  return problem;
}

const Register r{{.name = "double_pendulum",
                  .summary = "two point masses on massless rods",
                  .variants = {"equal", "heavy_tip", "light_tip"},
                  .build = build}};

}  // namespace
}  // namespace plumb::scenarios
