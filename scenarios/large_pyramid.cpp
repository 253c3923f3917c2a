#include "scenarios/truth/parts.h"

// A pyramid of boxes in rows, each box on the edges of two below it, a hundredth of a metre apart: it does
// not move. Source: statics.
namespace plumb::scenarios::large_pyramid {
namespace {
using namespace truth;

Problem build(std::string_view, int rows) {
  Problem problem{.scene = scene_of("large_pyramid", rows), .duration = 0.5};
  problem.scene.bodies = {ground(0.6)};
  for (int row = 0; row < rows; ++row)
    for (int i = 0; i < rows - row; ++i)
      problem.scene.bodies.push_back(
          piece("box", {1.01 * (i - (rows - row - 1) / 2.0), row + 0.5}, solid(Box{1, 1}, 0.6)));
  name_apart(problem.scene);
  problem.truth = equilibrium(problem.scene, "each box stands on two below it (statics)");
  problem.conserved = {.energy = true};
  problem.precise = within(1e-10);
  return problem;
}

const Register r{{.name = "large_pyramid",
                  .summary = "a pyramid of N rows of boxes",
                  .sizes = {2, 3},
                  .scales = true,
                  .build = build}};

}  // namespace
}  // namespace plumb::scenarios::large_pyramid
