#include <numbers>

#include "scenarios/truth/oscillator.h"
#include "scenarios/truth/parts.h"

// The springs of joints: a joint of f hertz and the damping ratio z swings as q'' = -w^2 q - 2 z w q', w = 2
// pi f, whatever the mass. Source: the damped oscillator, with the joint's own frequency.
namespace plumb::scenarios {
namespace {

using namespace truth;

constexpr double kShift = 0.3, kHertz = 1, kZeta = 0.2;  // m or rad, 1/s

Problem build(std::string_view variant, int) {
  Problem problem{.scene = scene_of("joint_springs", variant, 0), .duration = 2};
  const std::string world(kWorld);
  const Spring spring{kHertz, kZeta};
  Body box = piece("box", {}, untouchable(Box{0.5, 0.25}), 2);
  const bool turns = variant == "hinge" || variant == "weld";
  (turns ? box.angle : box.position.x) = kShift;
  problem.scene.bodies = {box};
  if (variant == "hinge")
    problem.scene.joints = {
        RevoluteJoint{.name = "spring", .body_a = world, .body_b = "box", .spring = spring}};
  if (variant == "weld")
    problem.scene.joints = {
        WeldJoint{.name = "spring", .body_a = world, .body_b = "box", .angular_spring = spring}};
  if (variant == "rail")
    problem.scene.joints = {
        PrismaticJoint{.name = "spring", .body_a = world, .body_b = "box", .spring = spring}};
  if (variant == "rod")
    problem.scene.joints = {DistanceJoint{.name = "spring",
                                          .body_a = world,
                                          .body_b = "box",
                                          .anchor_a = {-2, 0},
                                          .length = 2,
                                          .spring = spring}};
  problem.truth =
      follow(problem.scene, "q'' = -w^2 q - 2 z w q', w = 2 pi f", [turns](Real t, Moving moving) {
        const Swing now = damped_swing({kShift, 0}, 2 * std::numbers::pi_v<Real> * kHertz, kZeta, t);
        (turns ? moving[0].angle : moving[0].position.x) = now.place;
        (turns ? moving[0].angular_velocity : moving[0].velocity.x) = now.rate;
      });
  problem.precise = within(1e-9);
  return problem;
}

const Register r{{.name = "joint_springs",
                  .summary = "the springs of a hinge, a weld, a rail and a rod",
                  .variants = {"hinge", "weld", "rail", "rod"},
                  .build = build}};

}  // namespace
}  // namespace plumb::scenarios
