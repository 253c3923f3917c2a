#include <numbers>

#include "scenarios/truth/orbit.h"
#include "scenarios/truth/parts.h"

// Two bodies attract each other and orbit their centre of mass: the vector between them moves on Kepler's
// ellipse with mu = s (1 + m/M). Source: Newton, Principia, I, 57 to 59.
namespace plumb::scenarios::two_body {
namespace {
using namespace truth;

constexpr double kLight = 1, kHeavy = 3;  // kg

Problem build(std::string_view variant, int) {
  const double e = choose(variant, {{"circle", 0}, {"ellipse", 0.5}});
  Problem problem{.scene = scene_of("two_body", variant, 0), .duration = 2 * std::numbers::pi};
  const double light = kHeavy / (kLight + kHeavy), heavy = light - 1;  // parts of the way between them
  const Vec2d way{1 - e, 0}, rate = orbit(e, 0).velocity.as<double>();
  problem.scene.bodies = {
      thrown(piece("light", light * way, untouchable(Circle{0.1}), kLight), light * rate, 1),
      thrown(piece("heavy", heavy * way, untouchable(Circle{0.15}), kHeavy), heavy * rate, -2)};
  problem.scene.forces = {AttractionForce{.body = "light", .centre_body = "heavy", .strength = light}};
  const auto path = [=](Real t, Moving moving) {
    const Motion now = orbit(e, t);
    moving[0] = {light * now.position, t, light * now.velocity, 1};
    moving[1] = {heavy * now.position, -2 * t, heavy * now.velocity, -2};
  };
  problem.truth = follow(problem.scene, "Kepler's equation for the vector between them", path);
  problem.conserved = {.energy = true, .momentum_x = true, .momentum_y = true, .angular_momentum = true};
  problem.precise = within(1e-7);
  return problem;
}

const Register r{{.name = "two_body",
                  .summary = "two bodies circle their centre of mass",
                  .variants = {"circle", "ellipse"},
                  .build = build}};

}  // namespace
}  // namespace plumb::scenarios::two_body
