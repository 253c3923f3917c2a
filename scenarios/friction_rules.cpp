#include <cmath>

#include "scenarios/truth/parts.h"

// Blocks on a slope whose friction is combined from 0.2 and 0.6 by each rule: a = g (sin - mu cos). Source:
// Coulomb.
namespace plumb::scenarios::friction_rules {
namespace {
using namespace truth;

constexpr double kTilt = 0.7;  // rad

Problem build(std::string_view variant, int) {
  Problem problem{.scene = scene_of("friction_rules", variant), .duration = 1};
  const std::vector<Combine> rules = {Combine::GeometricMean, Combine::Product, Combine::Maximum,
                                      Combine::Minimum, Combine::Average};
  const auto which = static_cast<std::size_t>(choose(
      variant, {{"geometric_mean", 0}, {"product", 1}, {"maximum", 2}, {"minimum", 3}, {"average", 4}}));
  const std::vector<Real> friction = {std::sqrt(Real(0.12)), 0.12L, 0.6L, 0.2L, 0.4L};
  problem.scene.contact_rules.friction = rules[which];
  problem.scene.bodies = {ramp(kTilt, 0.2),
                          on_ramp(kTilt, piece("block", {}, solid(Box{0.5, 0.25}, 0.6)), 0.125)};
  const Vec2<Real> down = direction(-Real(kTilt));
  const Real a = kGravity * (-down.y - friction[which] * down.x);
  problem.truth =
      follow_in_contact(problem.scene, "a = g (sin - mu cos) (Coulomb)",
                        [=](Real t, Moving moving) { moving[0] = coast(moving[0], t, {a * down}); });
  problem.precise = within(1e-10);
  return problem;
}

const Register r{{.name = "friction_rules",
                  .summary = "blocks whose friction each rule combines from two coefficients",
                  .variants = {"geometric_mean", "product", "maximum", "minimum", "average"},
                  .build = build}};

}  // namespace
}  // namespace plumb::scenarios::friction_rules
