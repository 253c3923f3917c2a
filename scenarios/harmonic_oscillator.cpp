#include <cmath>

#include "scenarios/scenario.h"
#include "scenarios/truth/stepping.h"

// A mass on a spring: x = x0 cos(w t), w^2 = k/m. Semi-implicit Euler oscillates at w' with sin(w' h/2) = w
// h/2, and explicit Euler multiplies the energy by 1 + w^2 h^2 a step: the recurrence gives both.
namespace plumb::scenarios::harmonic_oscillator {
namespace {
using namespace truth;

constexpr double kMass = 2, kStiffness = 8, kStart = 0.5, kRest = 3;  // kg, N/m, m, m

Problem build(std::string_view, int) {
  Problem problem{.scene = {.name = "harmonic_oscillator", .gravity = {0, 0}}, .duration = 3};
  Scene& scene = problem.scene;
  scene.bodies = {
      {.name = "mass", .position = {kStart, 0}, .mass = kMass, .shapes = {untouchable(Circle{0.1})}}};
  scene.forces = {SpringForce{"world", "mass", {-kRest, 0}, {}, kRest, kStiffness}};
  const Real square = Real(kStiffness) / kMass, w = std::sqrt(square);
  const auto law = [=](std::size_t, double, const Motion& m) -> Acceleration {
    return {.linear = -square * m.position};
  };
  problem.truth = {.source = "x0 cos(w t), w^2 = k/m (Hooke, Newton)",
                   .exact =
                       [=](double t, std::span<BodyState> out) {
                         const Vec2<Real> turn = direction(w * t);
                         out[0] = rounded({{kStart * turn.x, 0}, 0, {-kStart * w * turn.y, 0}, 0});
                       },
                   .discrete = discrete_euler(motions_of(scene), law)};
  problem.conserved = {.energy = true};
  problem.precise = {.position = 1e-9, .velocity = 1e-9, .energy = 1e-9};
  return problem;
}

const Register r{{.name = "harmonic_oscillator", .summary = "a mass swings on a spring", .build = build}};

}  // namespace
}  // namespace plumb::scenarios::harmonic_oscillator
