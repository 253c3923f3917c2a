#include <numbers>

#include "scenarios/truth/oscillator.h"
#include "scenarios/truth/parts.h"

// The springs of a hinge and of a weld: a joint of f hertz and the damping ratio z swings as
// q'' = -w^2 q - 2 z w q', w = 2 pi f, whatever the inertia. Source: the damped oscillator.
namespace plumb::scenarios::turning_springs {
namespace {
using namespace truth;

constexpr double kTurn = 0.3, kHertz = 1, kZeta = 0.2;  // rad, 1/s

Problem build(std::string_view variant, int) {
  Problem problem{.scene = scene_of("turning_springs", variant, 0), .duration = 2};
  problem.scene.bodies = {piece("box", {}, untouchable(Box{0.5, 0.25}), 2)};
  problem.scene.bodies[0].angle = kTurn;
  RevoluteJoint hinged = hinge(kWorld, {}, "box", {});
  hinged.spring = Spring{kHertz, kZeta};
  const WeldJoint weld{
      .name = "weld", .body_a = "world", .body_b = "box", .angular_spring = Spring{kHertz, kZeta}};
  problem.scene.joints = {variant == "hinge" ? Joint(hinged) : Joint(weld)};
  const Real w = 2 * std::numbers::pi_v<Real> * kHertz;
  problem.truth = follow(problem.scene, "q'' = -w^2 q - 2 z w q', w = 2 pi f", [w](Real t, Moving moving) {
    const Swing now = damped_swing({kTurn, 0}, w, kZeta, t);
    moving[0].angle = now.place;
    moving[0].angular_velocity = now.rate;
  });
  problem.precise = within(1e-9);
  return problem;
}

const Register r{{.name = "turning_springs",
                  .summary = "the springs of a hinge and of a weld",
                  .variants = {"hinge", "weld"},
                  .build = build}};

}  // namespace
}  // namespace plumb::scenarios::turning_springs
