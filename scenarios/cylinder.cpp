#include "scenarios/truth/cylinder.h"
#include "scenarios/truth/parts.h"

// A disc that slides off a fixed cylinder leaves it at cos(a) = (2/3) cos(a0). A rolling disc first slips,
// where m g sin(a)/3 = mu N, and then leaves it. Source: e.g. Kleppner and Kolenkow, 5.6; `cylinder_truth`.
namespace plumb::scenarios::cylinder {
namespace {
using namespace truth;

Problem build(std::string_view variant, int) {
  const double friction = choose(variant, {{"slides", 0}, {"rolls", 0.6}}), from = 0.3;
  Problem problem{.scene = cylinder_scene(scene_of("cylinder", variant), from, friction), .duration = 1.1};
  problem.truth = cylinder_truth(problem.scene, from, friction, problem.duration);
  problem.conserved = {.energy = friction == 0};
  problem.precise = within(1e-9);
  return problem;
}

const Register r{{.name = "cylinder",
                  .summary = "a disc slides or rolls off a cylinder and leaves it",
                  .variants = {"slides", "rolls"},
                  .build = build}};

}  // namespace
}  // namespace plumb::scenarios::cylinder
