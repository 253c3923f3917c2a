#include <cmath>

#include "scenarios/truth/parts.h"

// Velocities decay by a body's damping, v = v0 e^(-c t), and with gravity v = g/c + (v0 - g/c) e^(-c t).
// Source: the linear first-order equation.
namespace plumb::scenarios::damped_coasting {
namespace {
using namespace truth;

constexpr double kLinear = 0.8, kAngular = 1.5;  // 1/s

Problem build(std::string_view variant, int) {
  const double gravity = choose(variant, {{"afloat", 0}, {"falling", kGravity}});
  Problem problem{.scene = scene_of("damped_coasting", variant, gravity), .duration = 2};
  Body body = thrown(piece("body", {}, untouchable(Box{0.5, 0.25}), 2), {3, 1}, 5);
  body.linear_damping = kLinear;
  body.angular_damping = kAngular;
  problem.scene.bodies = {body};
  problem.truth = follow(problem.scene, "v = u + (v0 - u) e^(-c t), u = g/c", [=](Real t, Moving moving) {
    const Motion from = moving[0];
    const Real slowed = -std::expm1(-kLinear * t), braked = -std::expm1(-kAngular * t);
    const Vec2<Real> last{0, -gravity / Real(kLinear)}, excess = from.velocity - last;
    moving[0] = {t * last + slowed / kLinear * excess, braked / kAngular * from.angular_velocity,
                 from.velocity - slowed * excess, (1 - braked) * from.angular_velocity};
  });
  problem.precise = within(1e-9);
  return problem;
}

const Register r{{.name = "damped_coasting",
                  .summary = "a body whose damping slows it down",
                  .variants = {"afloat", "falling"},
                  .build = build}};

}  // namespace
}  // namespace plumb::scenarios::damped_coasting
