#include <cmath>

#include "scenarios/truth/billiard.h"
#include "scenarios/truth/parts.h"

// A spinning disc of 1 kg hits another off-centre, both rough: friction stops the slip u by J_t = -m u/6, if
// mu J_n permits, and spins both. Source: Garwin, Am. J. Phys. 37 (1969), with tangential restitution 0.
namespace plumb::scenarios::rough_collision {
namespace {
using namespace truth;

constexpr double kCue = 0.25, kObject = 0.5, kRestitution = 0.8;  // m, radii

Problem build(std::string_view variant, int) {
  const double friction = choose(variant, {{"grips", 0.8}, {"slips", 0.1}});
  Problem problem{.scene = scene_of("rough_collision", variant, 0), .duration = 1};
  const Body cue = piece("cue", {-2, 0.2}, solid(Circle{kCue}, friction, kRestitution));
  const Body object = piece("object", {}, solid(Circle{kObject}, friction, kRestitution));
  problem.scene.bodies = {thrown(cue, {3, 0.3}, 8), object};
  const Motion a = motion_of(problem.scene.bodies[0]);
  const Real at = time_to_touch({1, kCue, a}, {1, kObject, motion_of(object)});
  const Vec2<Real> n = -1 / Real(kCue + kObject) * coast(a, at).position, across = perpendicular(n);
  const Real push = (1 + Real(kRestitution)) * dot(a.velocity, n) / 2;
  const Real rub = -std::fmin((dot(a.velocity, across) + a.angular_velocity * kCue) / 6, friction * push);
  const Vec2<Real> impulse = rub * across - push * n;  // on the cue
  problem.truth = one_impact(problem.scene, "Newton's restitution; friction ends the slip, or slips", at,
                             {{impulse, 2 * rub / kCue}, {-impulse, 2 * rub / kObject}});
  problem.conserved = {.momentum_x = true, .momentum_y = true, .angular_momentum = true};
  problem.precise = within(1e-10);
  return problem;
}

const Register r{{.name = "rough_collision",
                  .summary = "a spinning disc hits another, with friction",
                  .variants = {"grips", "slips"},
                  .build = build}};

}  // namespace
}  // namespace plumb::scenarios::rough_collision
