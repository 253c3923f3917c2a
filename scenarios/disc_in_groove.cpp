#include <numbers>

#include "scenarios/truth/parts.h"
#include "scenarios/truth/set_up.h"

// A disc at rest between two smooth slopes, of 30 and 45 degrees. Source: statics.
namespace plumb::scenarios::disc_in_groove {
namespace {
using namespace truth;

Problem build(std::string_view, int) {
  Problem problem{.scene = scene_of("disc_in_groove"), .duration = 1};
  const double left = std::numbers::pi / 6, right = std::numbers::pi / 4, radius = 0.5;
  // Slopes through the origin that fall towards it; the centre is a radius away from both.
  const Vec2d along = set_up::direction(-left), beside = set_up::direction(right);
  const Vec2d n = perpendicular(along), m = perpendicular(beside);
  const Vec2d centre = radius / (1 + dot(n, m)) * (n + m);
  problem.scene.bodies = {fixed("left", -2.0 * n - along, solid(Box{4, 4}), -left),
                          fixed("right", -2.0 * m + beside, solid(Box{4, 4}), right),
                          piece("disc", centre, solid(Circle{radius}))};
  problem.truth = equilibrium(problem.scene, "two forces carry the weight (statics)");
  problem.conserved = {.energy = true};
  problem.precise = within(1e-10);
  return problem;
}

const Register r{{.name = "disc_in_groove", .summary = "a disc at rest between two slopes", .build = build}};

}  // namespace
}  // namespace plumb::scenarios::disc_in_groove
