#include <cmath>
#include <numbers>

#include "scenarios/scenario.h"
#include "scenarios/truth/motion.h"

// One orbit on an ellipse of eccentricity e = 0.6 about a fixed centre, from its pericentre: semi-major axis
// 1, mu = 1, period 2 pi. Kepler's equation M = E - e sin E by Newton's method.
namespace plumb::scenarios {
namespace {

using namespace truth;

constexpr Real kE = 0.6L;

void exact(double t, std::span<BodyState> out) {
  const Real minor = std::sqrt(1 - kE * kE);
  Real anomaly = t;
  for (int i = 0; i < 30; ++i)
    anomaly -= (anomaly - kE * std::sin(anomaly) - t) / (1 - kE * std::cos(anomaly));
  const auto [c, s] = direction(anomaly);
  const Real rate = 1 / (1 - kE * c);
  out[0] = rounded({{c - kE, minor * s}, 0, {-rate * s, rate * minor * c}, 0});
}

Problem build(std::string_view, int) {
  Problem problem{.scene = {.name = "kepler", .gravity = {0, 0}}, .duration = 2 * std::numbers::pi};
  problem.scene.bodies = {
      {.name = "planet", .position = {0.4, 0}, .velocity = {0, 2}, .shapes = {untouchable(Circle{0.01})}}};
  problem.scene.forces = {AttractionForce{.body = "planet", .strength = 1}};
  problem.truth = {.source = "Kepler's equation, e = 0.6, mu = 1", .exact = exact};
  problem.conserved = {.energy = true, .angular_momentum = true};
  problem.precise = {.position = 1e-7, .velocity = 1e-7, .energy = 1e-8, .angular_momentum = 1e-8};
  return problem;
}

const Register r{{.name = "kepler", .summary = "a planet on an ellipse, once round", .build = build}};

}  // namespace
}  // namespace plumb::scenarios
