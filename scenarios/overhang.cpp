#include "scenarios/truth/parts.h"

// N blocks stacked over the edge of a table, with the largest overhang less a thousandth: the k-th from the
// top overhangs the next by L/(2 k), all together by H_N/2 lengths. Source: e.g. Paterson and Zwick,
// Overhang, Am. Math. Monthly 116 (2009).
namespace plumb::scenarios::overhang {
namespace {
using namespace truth;

constexpr double kHeight = 0.25;  // m

Problem build(std::string_view, int count) {
  Problem problem{.scene = scene_of("overhang", count), .duration = 1};
  problem.scene.bodies = {fixed("table", {-4, -1}, solid(Box{8, 2}, 0.5))};
  double x = -0.5;
  for (int k = count; k > 0; --k)  // the k-th from the top
    problem.scene.bodies.push_back(
        piece("block", {x += 0.999 / (2 * k), kHeight * (count - k + 0.5)}, solid(Box{1, kHeight}, 0.5)));
  name_apart(problem.scene);
  problem.truth = equilibrium(problem.scene, "stands up to H_N/2 lengths (statics)");
  problem.conserved = {.energy = true};
  problem.precise = within(1e-9);
  return problem;
}

const Register r{{.name = "overhang",
                  .summary = "N blocks stacked over the edge of a table with the largest overhang",
                  .sizes = {1, 5},
                  .scales = true,
                  .build = build}};

}  // namespace
}  // namespace plumb::scenarios::overhang
