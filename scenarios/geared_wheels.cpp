#include "scenarios/truth/parts.h"

// Two wheels in gear, one of them driven: the torque accelerates the inertia I1 + r^2 I2, r the ratio of
// their speeds. Source: d'Alembert; virtual work.
namespace plumb::scenarios::geared_wheels {
namespace {
using namespace truth;

constexpr double kTorque = 0.5, kRatio = -2;  // N m, 1

Problem build(std::string_view, int) {
  Problem problem{.scene = scene_of("geared_wheels"), .duration = 1.5};
  problem.scene.bodies = {piece("large", {-0.6, 0}, untouchable(Circle{0.4}), 2),
                          piece("small", {0, 0}, untouchable(Circle{0.2}), 1)};
  problem.scene.joints = {hinge(kWorld, {-0.6, 0}, "large", {}), hinge(kWorld, {}, "small", {}),
                          GearJoint{.name = "teeth", .body_a = "large", .body_b = "small", .ratio = kRatio}};
  problem.scene.forces = {Torque{"large", kTorque}};
  const Real large = 2 * 0.4L * 0.4L / 2, small = 0.2L * 0.2L / 2;
  const Real turn = kTorque / (large + kRatio * kRatio * small);
  problem.truth = follow(problem.scene, "(I1 + r^2 I2) q'' = T", [turn](Real t, Moving moving) {
    moving[0] = coast(moving[0], t, {{}, turn});
    moving[1] = coast(moving[1], t, {{}, kRatio * turn});
  });
  problem.precise = within(1e-9);
  return problem;
}

const Register r{
    {.name = "geared_wheels", .summary = "two wheels in gear, one of them driven", .build = build}};

}  // namespace
}  // namespace plumb::scenarios::geared_wheels
