#include <cmath>

#include "engine/math/arc_tangent.h"
#include "scenarios/truth/parts.h"
#include "scenarios/truth/phases.h"

// A slender block on a rough slope: it tips over its lower edge iff tan(tilt) > width/height, and then turns
// about it like a pendulum. Source: statics; Euler, I = (4/3) m rho^2.
namespace plumb::scenarios::toppling_block {
namespace {
using namespace truth;

constexpr double kWidth = 0.4, kHeight = 1;  // m

Problem build(std::string_view variant, int) {
  const double tilt = arc_tangent(kWidth * (variant == "stands" ? 0.99 : 1.05), kHeight);
  Problem problem{.scene = scene_of("toppling_block", variant), .duration = 1};
  const Body block = piece("block", {}, solid(Box{kWidth, kHeight}, 2));
  problem.scene.bodies = {ramp(tilt, 2), on_ramp(tilt, block, kHeight / 2)};
  problem.truth = equilibrium(problem.scene, "stands iff tan(tilt) <= width/height");
  problem.conserved = {.energy = true};
  problem.precise = within(1e-9);
  if (variant == "stands") return problem;
  const Vec2<Real> edge = turned(-tilt, {kWidth / 2, 0});
  const Real rho = std::hypot(kWidth, kHeight) / 2, from = std::atan2(kHeight, -kWidth) - tilt;
  const auto law = [=](Real psi, Real) { return -kGravity * 3 / 4 / rho * std::cos(psi); };
  const Phases fall({from, 0}, {{second_order_law(law)}}, 1);
  problem.truth = turning_truth(problem.scene, "a pendulum about its edge", fall, edge, {rho, 0});
  problem.truth.contacts_last = true;
  return problem;
}

const Register r{{.name = "toppling_block",
                  .summary = "a slender block on a slope below and above its toppling angle",
                  .variants = {"stands", "topples"},
                  .build = build}};

}  // namespace
}  // namespace plumb::scenarios::toppling_block
