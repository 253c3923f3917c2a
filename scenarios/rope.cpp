#include <cmath>

#include "scenarios/truth/parts.h"
#include "scenarios/truth/phases.h"

// A mass falls freely until its rope is taut. The rope removes the velocity along it, and the mass swings on
// with the rest. Source: Galileo; a rope has no restitution; the pendulum.
namespace plumb::scenarios::rope {
namespace {
using namespace truth;

Problem build(std::string_view variant, int) {
  const double x = choose(variant, {{"stops", 0}, {"swings", 0.6}});
  Problem problem{.scene = scene_of("rope", variant), .duration = 1.5};
  problem.scene.bodies = {piece("mass", {x, -0.2}, untouchable(Circle{0.1}), 2)};
  DistanceJoint rope{.name = "rope", .body_a = "world", .body_b = "mass", .length = 1};
  rope.range = Range{0, 1};
  problem.scene.joints = {rope};
  const Real angle = std::asin(Real(x)), depth = std::cos(angle);
  const Real taut = std::sqrt(2 * (depth - Real(0.2)) / kGravity), rate = -kGravity * taut * std::sin(angle);
  const auto law = [](Real q, Real) { return -kGravity * std::sin(q); };
  const Phases swing({angle, rate}, {{second_order_law(law)}}, problem.duration);
  const auto path = [=](Real t, Moving moving) {
    const auto y = swing.at(std::fmax(t - taut, Real(0)));
    const Vec2<Real> arm = turned(y[0], {0, -1});
    moving[0] = t < taut ? coast(moving[0], t, {{0, -kGravity}}) : Motion{arm, 0, cross(y[1], arm), 0};
  };
  problem.truth =
      integrated(follow(problem.scene, "free fall, then a pendulum", path, {static_cast<double>(taut)}));
  problem.precise = within(1e-9);
  return problem;
}

const Register r{{.name = "rope",
                  .summary = "a mass falls until its rope is taut",
                  .variants = {"stops", "swings"},
                  .build = build}};

}  // namespace
}  // namespace plumb::scenarios::rope
