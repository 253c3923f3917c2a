#include <numbers>

#include "scenarios/truth/bob_chain.h"
#include "scenarios/truth/parts.h"

// Two point masses on massless rods, one below the other, released from the horizontal; the tip is as heavy
// as the other mass, heavier or lighter. Source: Lagrange; `BobChain`.
namespace plumb::scenarios::double_pendulum {
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
}  // namespace plumb::scenarios::double_pendulum
