#include <cmath>

#include "scenarios/truth/parts.h"

// A spinning disc hits another beside its centre, both rough: friction ends the slip u by J_t = -u/(3 (1/m1
// + 1/m2)), if mu J_n allows, and turns both. Source: Garwin, Am. J. Phys. 37 (1969), with tangential
// restitution 0.
namespace plumb::scenarios {
namespace {

using namespace truth;

constexpr double kRadius1 = 0.25, kRadius2 = 0.5, kMass1 = 1, kMass2 = 2, kRestitution = 0.8;  // m, kg
constexpr Real kInverse = 1 / Real(kMass1) + 1 / Real(kMass2);

Problem build(std::string_view variant, int) {
  const double friction = choose(variant, {{"grips", 0.8}, {"slips", 0.1}});
  Problem problem{.scene = scene_of("rough_collision", variant, 0), .duration = 1};
  const Body cue = piece("cue", {-2, 0.2}, solid(Circle{kRadius1}, friction, kRestitution), kMass1);
  const Body object = piece("object", {}, solid(Circle{kRadius2}, friction, kRestitution), kMass2);
  problem.scene.bodies = {thrown(cue, {3, 0.3}, 8), object};
  const Motion a = motion_of(problem.scene.bodies[0]);
  const Real reach = Real(kRadius1) + kRadius2, speed2 = length_squared(a.velocity);
  const Real miss = cross(a.position, a.velocity), along = -dot(a.position, a.velocity);
  const Real at = (along - std::sqrt(reach * reach * speed2 - miss * miss)) / speed2;
  const Vec2<Real> n = -1 / reach * coast(a, at).position, across = perpendicular(n);
  const Real push = (1 + Real(kRestitution)) * dot(a.velocity, n) / kInverse;
  const Real slip = dot(a.velocity, across) + a.angular_velocity * kRadius1;
  const Real rub = -std::fmin(slip / (3 * kInverse), friction * push);  // slip > 0
  const Vec2<Real> impulse = rub * across - push * n;                   // on the cue
  problem.truth = one_impact(problem.scene, "Newton's restitution; friction ends the slip, or slips", at,
                             {{1 / kMass1 * impulse, 2 * rub / kMass1 / kRadius1},
                              {-1 / kMass2 * impulse, 2 * rub / kMass2 / kRadius2}});
  problem.conserved = {.momentum_x = true, .momentum_y = true, .angular_momentum = true};
  problem.precise = within(1e-10);
  return problem;
}

const Register r{{.name = "rough_collision",
                  .summary = "a spinning disc hits another, with friction",
                  .variants = {"grips", "slips"},
                  .build = build}};

}  // namespace
}  // namespace plumb::scenarios
