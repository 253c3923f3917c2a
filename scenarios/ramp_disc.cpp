#include <cmath>

#include "scenarios/truth/parts.h"
#include "scenarios/truth/set_up.h"

// A disc on a ramp: it rolls iff mu >= tan(tilt)/3, at a = (2/3) g sin; else it slips at a = g (sin - mu
// cos), and friction turns it at 2 mu g cos/r. Source: Newton and Euler with Coulomb friction, I = m r^2/2.
namespace plumb::scenarios::ramp_disc {
namespace {
using namespace truth;

constexpr double kTilt = 0.4, kRadius = 0.25;  // rad, m

Problem build(std::string_view variant, int) {
  const double ratio =
      choose(variant, {{"rolls", 2}, {"barely_rolls", 1.001}, {"barely_slips", 0.999}, {"slips", 0.25}});
  const double friction = ratio * set_up::tangent(kTilt) / 3;
  Problem problem{.scene = scene_of("ramp_disc", variant), .duration = 1.5};
  const Body disc = piece("disc", {}, solid(Circle{kRadius}, friction), 2);
  problem.scene.bodies = {ramp(kTilt, friction), on_ramp(kTilt, disc, kRadius)};
  const Vec2<Real> down = direction(-kTilt);
  // Friction force divided by the mass: that needed for rolling, or the largest available.
  const Real rub = Real(kGravity) * std::fmin(-down.y / 3, friction * down.x);
  const Acceleration a{(Real(kGravity) * -down.y - rub) * down, -2 * rub / kRadius};
  problem.truth = follow_in_contact(
      problem.scene, "rolls iff mu >= tan(tilt)/3, at (2/3) g sin; else slips at g (sin - mu cos)",
      [=](Real t, Moving moving) { moving[0] = coast(moving[0], t, a); });
  problem.conserved = {.energy = ratio > 1};
  problem.precise = within(1e-10);
  return problem;
}

const Register r{{.name = "ramp_disc",
                  .summary = "a disc on a ramp, with friction above and below the value for rolling",
                  .variants = {"rolls", "barely_rolls", "barely_slips", "slips"},
                  .build = build}};

}  // namespace
}  // namespace plumb::scenarios::ramp_disc
