#include <cmath>

#include "scenarios/truth/parts.h"

// A mass on a spring, driven by F sin(W t) from rest: x = F/m/(w^2 - W^2) (sin W t - W/w sin w t), which
// grows as F/(2 m w^2) (sin w t - w t cos w t) at resonance. Source: e.g. Taylor, Classical Mechanics, 5.5.
namespace plumb::scenarios::driven_oscillator {
namespace {
using namespace truth;

constexpr double kMass = 2, kStiffness = 8, kForce = 3, kRest = 3;  // kg, N/m, N, m

Problem build(std::string_view variant, int) {
  const Real own = 2;  // rad/s, the root of k/m
  const double drive = choose(variant, {{"beats", 1.5}, {"resonance", 2}});
  Problem problem{.scene = scene_of("driven_oscillator", variant, 0), .duration = 4};
  problem.scene.bodies = {piece("mass", {}, untouchable(Circle{0.1}), kMass)};
  problem.scene.forces = {SpringForce{"world", "mass", {-kRest, 0}, {}, kRest, kStiffness},
                          SinusoidalForce{"mass", {kForce, 0}, {}, drive}};
  const auto path = [=](Real t, Moving moving) {
    const auto [c, s] = direction(own * t);
    const auto [cd, sd] = direction(drive * t);
    const bool same = drive == own;
    const Real size = kForce / kMass / (same ? 2 * own * own : own * own - drive * Real(drive));
    moving[0].position.x = size * (same ? s - own * t * c : sd - drive / own * s);
    moving[0].velocity.x = size * (same ? own * own * t * s : drive * (cd - c));
  };
  problem.truth = follow(problem.scene, "free and driven oscillation superposed (closed form)", path);
  problem.precise = within(1e-9);
  return problem;
}

const Register r{{.name = "driven_oscillator",
                  .summary = "a mass on a spring, driven near resonance and at it",
                  .variants = {"beats", "resonance"},
                  .build = build}};

}  // namespace
}  // namespace plumb::scenarios::driven_oscillator
