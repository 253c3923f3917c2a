#include <cmath>

#include "scenarios/truth/parts.h"

// A disc slides, spins, or spins backwards on level ground until it rolls. The slip u = v + w r decays at 3
// mu g, so the disc rolls after |u|/(3 mu g). From v0 without spin: t = v0/(3 mu g), v = 2 v0/3. Source:
// Coulomb; Euler, 1758; Coriolis, Theorie mathematique des effets du jeu de billard, 1835.
namespace plumb::scenarios::slide_to_roll {
namespace {
using namespace truth;

constexpr double kFriction = 0.2, kRadius = 0.25;  // m

Problem build(std::string_view variant, int) {
  Problem problem{.scene = scene_of("slide_to_roll", variant), .duration = 2};
  Body disc{.name = "disc", .position = {-2, kRadius}, .shapes = {solid(Circle{kRadius}, kFriction)}};
  disc.velocity.x = variant == "slide" ? 5 : variant == "backspin" ? 2 : 0;
  disc.angular_velocity = variant == "slide" ? 0 : variant == "backspin" ? 30 : -20;
  problem.scene.bodies = {ground(kFriction), disc};
  const Real slip = Real(disc.velocity.x) + Real(disc.angular_velocity) * kRadius;
  const Real rub = -std::copysign(Real(kFriction) * kGravity, slip), rolls_at = std::fabs(slip / (3 * rub));
  problem.truth = follow_in_contact(
      problem.scene, "the slip decays at 3 mu g; rolls from |slip|/(3 mu g) on (Euler, Coulomb)",
      [=](Real t, Moving moving) {
        moving[0] = coast_until(moving[0], rolls_at, t, {{rub, 0}, 2 * rub / kRadius});
      });
  problem.precise = within(1e-10);
  return problem;
}

const Register r{{.name = "slide_to_roll",
                  .summary = "a sliding or spinning disc on level ground until it rolls",
                  .variants = {"slide", "spin", "backspin"},
                  .build = build}};

}  // namespace
}  // namespace plumb::scenarios::slide_to_roll
