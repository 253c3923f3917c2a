#include "scenarios/truth/parts.h"

// A force towards the origin, proportional to the distance: an ellipse about the origin, x = a cos w t, y =
// (v/w) sin w t. Source: Newton, Principia, I, 10.
namespace plumb::scenarios::central_spring {
namespace {
using namespace truth;

constexpr double kStrength = 4, kStart = 1.5, kSpeed = 1.2;  // 1/s^2, m, m/s

Problem build(std::string_view, int) {
  Problem problem{.scene = scene_of("central_spring", "", 0), .duration = 4};
  problem.scene.bodies = {thrown(piece("body", {kStart, 0}, untouchable(Circle{0.1}), 2), {0, kSpeed})};
  problem.scene.forces = {AttractionForce{.body = "body", .strength = kStrength, .exponent = -1}};
  problem.truth =
      follow(problem.scene, "x = a cos w t, y = (v/w) sin w t (Newton)", [](Real t, Moving moving) {
        const Real w = 2;  // rad/s, the root of the strength
        const auto [c, s] = direction(w * t);
        moving[0] = {{kStart * c, kSpeed / w * s}, 0, {-kStart * w * s, kSpeed * c}, 0};
      });
  problem.conserved = {.energy = true, .angular_momentum = true};
  problem.precise = within(1e-9);
  return problem;
}

const Register r{{.name = "central_spring",
                  .summary = "a body attracted to a point in proportion to its distance",
                  .build = build}};

}  // namespace
}  // namespace plumb::scenarios::central_spring
