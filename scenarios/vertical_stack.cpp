#include "scenarios/truth/parts.h"

// A stack of equal boxes on the ground stays as it is. Source: statics.
namespace plumb::scenarios::vertical_stack {
namespace {
using namespace truth;

Problem build(std::string_view, int count) {
  Problem problem{.scene = scene_of("vertical_stack", count), .duration = 1};
  problem.scene.bodies = {ground(0.5)};
  for (int i = 0; i < count; ++i)
    problem.scene.bodies.push_back(piece("box", {0, i + 0.5}, solid(Box{1, 1}, 0.5)));
  name_apart(problem.scene);
  problem.truth = equilibrium(problem.scene, "each box lies on the whole of its face (statics)");
  problem.conserved = {.energy = true};
  problem.precise = within(1e-10);
  return problem;
}

const Register r{{.name = "vertical_stack",
                  .summary = "N equal boxes on top of each other",
                  .sizes = {1, 3, 10},
                  .scales = true,
                  .build = build}};

}  // namespace
}  // namespace plumb::scenarios::vertical_stack
