#include "scenarios/truth/billiard.h"
#include "scenarios/truth/parts.h"

// Three discs in a square of walls, elastic. Source: reflection; conservation of momentum and energy.
namespace plumb::scenarios::billiard_table {
namespace {
using namespace truth;

Problem build(std::string_view, int) {
  Problem problem{.scene = scene_of("billiard_table", "", 0), .duration = 3};
  const Shape cushion = solid(Box{8, 2}, 0, 1), upright = solid(Box{2, 8}, 0, 1);
  problem.scene.bodies = {fixed("south", {0, -3}, cushion),
                          fixed("north", {0, 3}, cushion),
                          fixed("west", {-3, 0}, upright),
                          fixed("east", {3, 0}, upright),
                          piece("first", {-1, -0.3}, solid(Circle{0.25}, 0, 1)),
                          piece("second", {0.4, 0}, solid(Circle{0.3}, 0, 1), 2),
                          piece("third", {1, 1.1}, solid(Circle{0.35}, 0, 1), 3)};
  problem.scene.bodies[4].velocity = {2.5, 0.7};
  problem.scene.bodies[6].velocity = {-0.4, -1.1};
  problem.truth =
      billiard_truth(problem.scene, problem.duration,
                     {{{0, -2}, {0, 1}}, {{0, 2}, {0, -1}}, {{-2, 0}, {1, 0}}, {{2, 0}, {-1, 0}}});
  problem.conserved = {.energy = true};
  problem.precise = within(1e-9);
  return problem;
}

const Register r{{.name = "billiard_table", .summary = "three discs in a square of walls", .build = build}};

}  // namespace
}  // namespace plumb::scenarios::billiard_table
