#include "scenarios/truth/ladder.h"
#include "scenarios/truth/parts.h"
#include "scenarios/truth/set_up.h"

// A uniform ladder on a rough floor and a smooth wall, at an angle a from the vertical, stands iff mu >=
// tan(a)/2; so do two cards that lean on each other. Otherwise it slips: `Ladder`. Source: statics; Coulomb.
namespace plumb::scenarios::leaning_ladder {
namespace {
using namespace truth;

constexpr double kAngle = 0.5;  // rad, from the vertical

Problem build(std::string_view variant, int) {
  const double friction = (variant == "stands" ? 1.01 : 0.8) * set_up::tangent(kAngle) / 2;
  Problem problem{.scene = ladder_scene("leaning_ladder", variant, kAngle, friction), .duration = 0.6};
  problem.truth = variant == "stands" ? equilibrium(problem.scene, "stands iff mu >= tan(a)/2")
                                      : ladder_truth(problem.scene, kAngle, friction, problem.duration);
  problem.precise = within(1e-9);
  return problem;
}

const Register r{
    {.name = "leaning_ladder",
     .summary = "a ladder on a rough floor and a smooth wall, with enough friction and with less",
     .variants = {"stands", "slips"},
     .build = build}};

}  // namespace
}  // namespace plumb::scenarios::leaning_ladder
