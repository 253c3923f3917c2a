#include "scenarios/truth/billiard.h"
#include "scenarios/truth/parts.h"

// Galperin's billiard: a ball at rest beside a wall is hit by one of 100^n times its mass; all impacts are
// elastic. There are 3, 31, 314 impacts: the first n + 1 digits of pi. Source: Galperin, Playing pool with
// pi, Regul. Chaotic Dyn. 8 (2003).
namespace plumb::scenarios::pi_billiard {
namespace {
using namespace truth;

Problem build(std::string_view variant, int) {
  const double mass = choose(variant, {{"3", 1}, {"31", 100}, {"314", 1e4}});
  Problem problem{.scene = scene_of("pi_billiard", variant, 0), .duration = 4};
  problem.scene.bodies = {fixed("wall", {-1, 0}, solid(Box{2, 4}, 0, 1)),
                          piece("small", {1.01, 0}, solid(Circle{0.25}, 0, 1)),
                          piece("large", {2.53, 0}, solid(Circle{0.5}, 0, 1), mass)};
  problem.scene.bodies[2].velocity = {-1, 0};
  problem.truth = billiard_truth(problem.scene, problem.duration, {{{0, 0}, {1, 0}}});
  problem.conserved = {.energy = true};
  problem.precise = within(1e-9);
  return problem;
}

const Register r{{.name = "pi_billiard",
                  .summary = "two balls and a wall whose collisions count the digits of pi",
                  .variants = {"3", "31", "314"},
                  .build = build}};

}  // namespace
}  // namespace plumb::scenarios::pi_billiard
