#include <cmath>

#include "scenarios/truth/oscillator.h"
#include "scenarios/truth/parts.h"

// A mass on a damped spring, below, at and above critical damping. Source: Taylor, Classical Mechanics, 5.4.
namespace plumb::scenarios::damped_oscillator {
namespace {
using namespace truth;

constexpr double kMass = 2, kStiffness = 8, kStart = 0.5, kRest = 3;  // kg, N/m, m, m

Problem build(std::string_view variant, int) {
  const double zeta = choose(variant, {{"light", 0.1}, {"critical", 1}, {"strong", 2}});
  Problem problem{.scene = scene_of("damped_oscillator", variant, 0), .duration = 3};
  problem.scene.bodies = {piece("mass", {kStart, 0}, untouchable(Circle{0.1}), kMass)};
  const double w = 2;  // rad/s, the root of k/m
  problem.scene.forces = {
      SpringForce{"world", "mass", {-kRest, 0}, {}, kRest, kStiffness, 2 * zeta * w * kMass}};
  problem.truth =
      follow(problem.scene, "x'' = -w^2 x - 2 zeta w x' (closed form)", [=](Real t, Moving moving) {
        const Swing now = damped_swing({kStart, 0}, w, zeta, t);
        moving[0].position.x = now.place;
        moving[0].velocity.x = now.rate;
      });
  problem.precise = within(1e-9);
  return problem;
}

const Register r{{.name = "damped_oscillator",
                  .summary = "a mass on a damped spring",
                  .variants = {"light", "critical", "strong"},
                  .build = build}};

}  // namespace
}  // namespace plumb::scenarios::damped_oscillator
