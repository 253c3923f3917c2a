#include <cmath>

#include "scenarios/truth/parts.h"

// A disc strikes a free rod at rest, at the distance d from its centre. The rod rotates about the point
// L^2/(12 d) on the other side of its centre (the counterpart of the centre of percussion; here (L^2 +
// h^2)/(12 d), for a rod of thickness h). Source: Newton's restitution with J = (1 + e) u/(1/m + 1/M +
// d^2/I).
namespace plumb::scenarios::struck_rod {
namespace {
using namespace truth;

constexpr double kSpeed = 3, kMass = 3, kLength = 2, kThick = 0.1, kOff = 0.7, kRadius = 0.2;
constexpr double kStart = -1.13;  // m, of the disc's centre

Problem build(std::string_view variant, int) {
  const double e = choose(variant, {{"elastic", 1}, {"half_elastic", 0.5}});
  Problem problem{.scene = scene_of("struck_rod", variant, 0), .duration = 0.7};
  problem.scene.bodies = {piece("rod", {0, 0}, solid(Box{kThick, kLength}, 0, e), kMass),
                          thrown(piece("disc", {kStart, kOff}, solid(Circle{kRadius}, 0, e)), {kSpeed, 0})};
  const Real at = (-kThick / Real(2) - kRadius - kStart) / kSpeed;
  const Real inertia = kMass * (Real(kLength) * kLength + Real(kThick) * kThick) / 12;
  const Real impulse = (1 + Real(e)) * kSpeed / (1 + 1 / Real(kMass) + Real(kOff) * kOff / inertia);
  problem.truth = one_impact(problem.scene, "J = (1 + e) u/(1/m + 1/M + d^2/I) (Newton)", at,
                             {{{impulse / kMass, 0}, -kOff * impulse / inertia}, {{-impulse, 0}}});
  problem.conserved = {.energy = e == 1, .momentum_x = true, .momentum_y = true, .angular_momentum = true};
  problem.precise = within(1e-10);
  return problem;
}

const Register r{{.name = "struck_rod",
                  .summary = "a disc strikes a free rod off-centre",
                  .variants = {"elastic", "half_elastic"},
                  .build = build}};

}  // namespace
}  // namespace plumb::scenarios::struck_rod
