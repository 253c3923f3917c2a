#include <cmath>

#include "scenarios/truth/parts.h"

// A spinning disc lands on rough ground. The impulse of friction stops the slip u, J_t = -m u/3, if mu
// permits; otherwise it is mu times the normal impulse, (1 + e) m v. Source: Routh, Dynamics of a System of
// Rigid Bodies, I, ch. 4; tangential restitution 0.
namespace plumb::scenarios::landing_spin {
namespace {
using namespace truth;

constexpr double kHeight = 0.5, kRadius = 0.25, kRestitution = 0.6, kSpeed = 2, kSpin = 10;  // SI

Problem build(std::string_view variant, int) {
  const double friction = choose(variant, {{"grips", 0.5}, {"slips", 0.1}});
  Problem problem{.scene = scene_of("landing_spin", variant), .duration = 0.65};
  const Shape shape = solid(Circle{kRadius}, friction, kRestitution);
  problem.scene.bodies = {ground(friction, kRestitution),
                          thrown(piece("disc", {-1, kRadius + kHeight}, shape), {kSpeed, 0}, kSpin)};
  const Real at = std::sqrt(2 * Real(kHeight) / kGravity), normal = (1 + Real(kRestitution)) * kGravity * at;
  const Real slip = kSpeed + Real(kSpin) * kRadius, rub = -std::fmin(slip / 3, friction * normal);
  problem.truth = one_impact(problem.scene, "J_t = -m u/3, or mu (1 + e) m v (Routh)", at,
                             {{{rub, normal}, 2 * rub / kRadius}});
  problem.precise = within(1e-10);
  return problem;
}

const Register r{{.name = "landing_spin",
                  .summary = "a spinning disc lands with enough friction to grip, or too little",
                  .variants = {"grips", "slips"},
                  .build = build}};

}  // namespace
}  // namespace plumb::scenarios::landing_spin
