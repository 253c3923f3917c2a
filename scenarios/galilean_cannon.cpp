#include "scenarios/truth/billiard.h"
#include "scenarios/truth/parts.h"

// A light ball is dropped together with a heavier one close below it. The heavy one bounces first, and the
// light one leaves at (3 m1 - m2)/(m1 + m2) times the speed, apart from the effect of the gap. With three
// balls this happens twice. Source: Harter et al., Am. J. Phys. 39 (1971).
namespace plumb::scenarios::galilean_cannon {
namespace {
using namespace truth;

Problem build(std::string_view variant, int) {
  Problem problem{.scene = scene_of("galilean_cannon", variant), .duration = 0.75};
  problem.scene.bodies = {ground(0, 1), piece("heavy", {0, 1.3}, solid(Circle{0.3}, 0, 1), 9),
                          piece("middle", {0, 1.81}, solid(Circle{0.2}, 0, 1), 3)};
  if (variant == "three")
    problem.scene.bodies.push_back(piece("light", {0, 2.12}, solid(Circle{0.1}, 0, 1), 0.5));
  problem.truth = billiard_truth(problem.scene, problem.duration, {{{0, 0}, {0, 1}}});
  problem.conserved = {.energy = true};
  problem.precise = within(1e-9);
  return problem;
}

const Register r{{.name = "galilean_cannon",
                  .summary = "balls dropped on top of each other: the lightest flies up",
                  .variants = {"two", "three"},
                  .build = build}};

}  // namespace
}  // namespace plumb::scenarios::galilean_cannon
