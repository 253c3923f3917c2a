#include <numbers>

#include "scenarios/scenario.h"
#include "scenarios/truth/orbit.h"

// One orbit on an ellipse of eccentricity e = 0.6 about a fixed centre, from its pericentre: semi-major axis
// 1, mu = 1, period 2 pi. Kepler's equation M = E - e sin E by Newton's method.
namespace plumb::scenarios::kepler {
namespace {
using namespace truth;

Problem build(std::string_view, int) {
  Problem problem{.scene = {.name = "kepler", .gravity = {0, 0}}, .duration = 2 * std::numbers::pi};
  problem.scene.bodies = {
      {.name = "planet", .position = {0.4, 0}, .velocity = {0, 2}, .shapes = {untouchable(Circle{0.01})}}};
  problem.scene.forces = {AttractionForce{.body = "planet", .strength = 1}};
  problem.truth = {.source = "Kepler's equation, e = 0.6, mu = 1",
                   .exact = [](double t, std::span<BodyState> out) { out[0] = rounded(orbit(0.6L, t)); }};
  problem.conserved = {.energy = true, .angular_momentum = true};
  problem.precise = {.position = 1e-7, .velocity = 1e-7, .energy = 1e-8, .angular_momentum = 1e-8};
  return problem;
}

const Register r{
    {.name = "kepler", .summary = "a planet on an elliptic orbit, one revolution", .build = build}};

}  // namespace
}  // namespace plumb::scenarios::kepler
