#include <numbers>

#include "scenarios/truth/oscillator.h"
#include "scenarios/truth/parts.h"

// The springs of a rail and of a rod: a joint of f hertz and the damping ratio z swings as
// q'' = -w^2 q - 2 z w q', w = 2 pi f, whatever the mass. Source: the damped oscillator.
namespace plumb::scenarios::sliding_springs {
namespace {
using namespace truth;

constexpr double kShift = 0.3, kHertz = 1, kZeta = 0.2;  // m, 1/s

Problem build(std::string_view variant, int) {
  Problem problem{.scene = scene_of("sliding_springs", variant, 0), .duration = 2};
  problem.scene.bodies = {piece("box", {kShift, 0}, untouchable(Box{0.5, 0.25}), 2)};
  PrismaticJoint rail{.name = "rail", .body_a = "world", .body_b = "box"};
  rail.spring = Spring{kHertz, kZeta};
  DistanceJoint rod{.name = "rod", .body_a = "world", .body_b = "box", .anchor_a = {-2, 0}, .length = 2};
  rod.spring = rail.spring;
  problem.scene.joints = {variant == "rail" ? Joint(rail) : Joint(rod)};
  const Real w = 2 * std::numbers::pi_v<Real> * kHertz;
  problem.truth = follow(problem.scene, "q'' = -w^2 q - 2 z w q', w = 2 pi f", [w](Real t, Moving moving) {
    const Swing now = damped_swing({kShift, 0}, w, kZeta, t);
    moving[0].position.x = now.place;
    moving[0].velocity.x = now.rate;
  });
  problem.precise = within(1e-9);
  return problem;
}

const Register r{{.name = "sliding_springs",
                  .summary = "the springs of a rail and of a rod",
                  .variants = {"rail", "rod"},
                  .build = build}};

}  // namespace
}  // namespace plumb::scenarios::sliding_springs
