#include "scenarios/truth/bounces.h"
#include "scenarios/truth/parts.h"

// A ball dropped from h bounces with restitution e. It comes to rest after T = sqrt(2 h/g) (1 + e)/(1 - e)
// and infinitely many bounces; with e = 1 it never does. Source: geometric series; e.g. Falcon et al., Eur.
// Phys. J. B 3 (1998).
namespace plumb::scenarios::bounce {
namespace {
using namespace truth;

constexpr double kHeight = 1, kRadius = 0.25;  // m

Problem build(std::string_view variant, int) {
  const double e = choose(variant, {{"e_0", 0}, {"e_half", 0.5}, {"e_80", 0.8}, {"e_1", 1}});
  Problem problem{.scene = scene_of("bounce", variant), .duration = e == 0.8 ? 5.0 : 2.5};
  problem.scene.bodies = {ground(0, e), piece("ball", {0, kRadius + kHeight}, solid(Circle{kRadius}, 0, e))};
  const Bounces bounces(kHeight, kGravity, e, problem.duration);
  const auto path = [bounces](Real t, Moving moving) {
    const Swing now = bounces.at(t);
    moving[0].position.y = kRadius + now.place;
    moving[0].velocity.y = now.rate;
  };
  problem.truth =
      follow_in_contact(problem.scene, "parabolas in a geometric series, then rest", path, bounces.impacts());
  problem.conserved = {.energy = e == 1};
  problem.precise = within(1e-9);
  return problem;
}

const Register r{{.name = "bounce",
                  .summary = "a dropped ball bounces until it rests",
                  .variants = {"e_0", "e_half", "e_80", "e_1"},
                  .build = build}};

}  // namespace
}  // namespace plumb::scenarios::bounce
