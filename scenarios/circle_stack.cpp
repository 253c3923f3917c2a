#include "scenarios/truth/parts.h"

// Discs piled up exactly above each other: an equilibrium, though not a stable one. Source: statics.
namespace plumb::scenarios::circle_stack {
namespace {
using namespace truth;

Problem build(std::string_view, int count) {
  Problem problem{.scene = scene_of("circle_stack", count), .duration = 1};
  problem.scene.bodies = {ground(0.5)};
  for (int i = 0; i < count; ++i)
    problem.scene.bodies.push_back(piece("disc", {0, i + 0.5}, solid(Circle{0.5}, 0.5)));
  name_apart(problem.scene);
  problem.truth = equilibrium(problem.scene, "the forces lie in one line (statics)");
  problem.conserved = {.energy = true};
  problem.precise = within(1e-10);
  return problem;
}

const Register r{{.name = "circle_stack",
                  .summary = "N discs balanced on top of each other",
                  .sizes = {2, 5},
                  .scales = true,
                  .build = build}};

}  // namespace
}  // namespace plumb::scenarios::circle_stack
