#include <cmath>

#include "scenarios/truth/parts.h"
#include "scenarios/truth/set_up.h"

// A block on a ramp: it slips iff tan(tilt) > mu, and then at a = g (sin - mu cos). Source: Coulomb, 1785.
namespace plumb::scenarios::ramp_block {
namespace {
using namespace truth;

constexpr double kTilt = 0.4;  // rad

Problem build(std::string_view variant, int) {
  const double ratio =
      choose(variant, {{"holds", 2}, {"barely_holds", 1.001}, {"barely_slips", 0.999}, {"slips", 0.25}});
  const double friction = ratio * set_up::tangent(kTilt);
  Problem problem{.scene = scene_of("ramp_block", variant), .duration = 1.5};
  const Body block = piece("block", {}, solid(Box{0.5, 0.25}, friction));
  problem.scene.bodies = {ramp(kTilt, friction), on_ramp(kTilt, block, 0.125)};
  const Vec2<Real> down = direction(-kTilt);
  const Real pull = Real(kGravity) * (-down.y - friction * down.x);
  problem.truth =
      follow_in_contact(problem.scene, "slips iff tan(tilt) > mu, then a = g (sin - mu cos) (Coulomb)",
                        [=](Real t, Moving moving) {
                          moving[0] = coast(moving[0], t, {.linear = std::fmax(pull, Real(0)) * down});
                        });
  problem.precise = within(1e-10);
  return problem;
}

const Register r{{.name = "ramp_block",
                  .summary = "a block on a ramp, with friction above and below the holding value",
                  .variants = {"holds", "barely_holds", "barely_slips", "slips"},
                  .build = build}};

}  // namespace
}  // namespace plumb::scenarios::ramp_block
