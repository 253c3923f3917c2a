#include "scenarios/truth/parts.h"

// Bodies with different fractions of gravity: a balloon rises, a weightless body moves in a straight line.
// Source: Galileo.
namespace plumb::scenarios::gravity_scales {
namespace {
using namespace truth;

Problem build(std::string_view, int) {
  Problem problem{.scene = scene_of("gravity_scales"), .duration = 1.5};
  for (const double scale : {-0.5, 0.0, 0.165, 2.0}) {
    Body body = thrown(piece("body", {8 * scale, 0}, untouchable(Circle{0.2})), {1, 2}, 3);
    body.gravity_scale = scale;
    problem.scene.bodies.push_back(body);
  }
  name_apart(problem.scene);
  problem.truth = follow(
      problem.scene, "x0 + v0 t + s g t^2/2 (Galileo)", [scene = problem.scene](Real t, Moving moving) {
        for (std::size_t i = 0; i < moving.size(); ++i)
          moving[i] = coast(moving[i], t, {{0, -kGravity * Real(scene.bodies[i].gravity_scale)}});
      });
  problem.conserved = {.energy = true, .momentum_x = true};
  problem.precise = within(1e-11);
  problem.second_order = exact_but_for_rounding();
  return problem;
}

const Register r{
    {.name = "gravity_scales", .summary = "bodies with negative, zero and double gravity", .build = build}};

}  // namespace
}  // namespace plumb::scenarios::gravity_scales
