#include "scenarios/truth/ladder.h"
#include "scenarios/truth/parts.h"

// A ladder slides down a smooth wall on a smooth floor. It leaves the wall at two thirds of its initial
// height, and keeps its horizontal velocity from then on. Source: e.g. Irodov, Problems in General Physics,
// 1.246; the ODEs are in `ladder_truth`.
namespace plumb::scenarios::ladder {
namespace {
using namespace truth;

constexpr double kAngle = 0.3;  // rad, from the vertical

Problem build(std::string_view, int) {
  Problem problem{.scene = ladder_scene("ladder", "", kAngle, 0), .duration = 0.7};
  problem.truth = ladder_truth(problem.scene, kAngle, 0, problem.duration);
  problem.conserved = {.energy = true};
  problem.precise = within(1e-9);
  return problem;
}

const Register r{{.name = "ladder", .summary = "a ladder slides down a wall and leaves it", .build = build}};

}  // namespace
}  // namespace plumb::scenarios::ladder
