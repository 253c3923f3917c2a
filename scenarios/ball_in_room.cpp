#include "scenarios/truth/billiard.h"
#include "scenarios/truth/parts.h"

// An elastic ball between four walls: the first scene for a newly written engine. Source: parabolas,
// reflected at the walls.
namespace plumb::scenarios::ball_in_room {
namespace {
using namespace truth;

Problem build(std::string_view variant, int) {
  const bool falls = choose(variant, {{"floating", 0}, {"falling", 1}}) > 0;
  Problem problem{.scene = scene_of("ball_in_room", variant, falls ? kGravity : 0), .duration = 2};
  const Shape across = solid(Box{8, 2}, 0, 1), upright = solid(Box{2, 8}, 0, 1);
  problem.scene.bodies = {fixed("floor", {0, -3}, across), fixed("ceiling", {0, 3}, across),
                          fixed("left wall", {-3, 0}, upright), fixed("right wall", {3, 0}, upright),
                          piece("ball", {-0.9, 0.3}, solid(Circle{0.3}, 0, 1))};
  problem.scene.bodies[4].velocity = {3.1, 1.7};
  problem.truth =
      billiard_truth(problem.scene, problem.duration,
                     {{{0, -2}, {0, 1}}, {{0, 2}, {0, -1}}, {{-2, 0}, {1, 0}}, {{2, 0}, {-1, 0}}});
  problem.conserved = {.energy = true};
  problem.precise = within(1e-9);
  return problem;
}

const Register r{{.name = "ball_in_room",
                  .summary = "a ball bounces off four walls",
                  .variants = {"floating", "falling"},
                  .build = build}};

}  // namespace
}  // namespace plumb::scenarios::ball_in_room
