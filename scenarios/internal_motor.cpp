#include "scenarios/truth/parts.h"

// A motor between two free wheels on one axle: they turn in opposite directions, w1 I1 + w2 I2 = 0,
// accelerated by the torque until they reach the motor's speed. Source: conservation of angular momentum.
namespace plumb::scenarios::internal_motor {
namespace {
using namespace truth;

constexpr double kTorque = 0.2, kInertia1 = 0.16, kInertia2 = 0.02;  // N m, kg m^2

Problem build(std::string_view variant, int) {
  const double speed = choose(variant, {{"pulls", 100}, {"reaches_its_speed", 8}});
  Problem problem{.scene = scene_of("internal_motor", variant, 0), .duration = 1.5};
  problem.scene.bodies = {thrown(piece("large", {}, untouchable(Circle{0.4}), 2), {0.5, 0.2}),
                          thrown(piece("small", {}, untouchable(Circle{0.2}), 1), {0.5, 0.2})};
  RevoluteJoint axle = hinge("large", {}, "small", {});
  axle.motor = Motor{speed, kTorque};
  problem.scene.joints = {axle};
  const Real up = kTorque / Real(kInertia2), down = -kTorque / Real(kInertia1), end = speed / (up - down);
  problem.truth =
      follow(problem.scene, "I w = T t on both wheels, up to the motor's speed", [=](Real t, Moving moving) {
        moving[0] = coast_until(moving[0], end, t, {{}, down});
        moving[1] = coast_until(moving[1], end, t, {{}, up});
      });
  problem.conserved = {.momentum_x = true, .momentum_y = true, .angular_momentum = true};
  problem.precise = within(1e-9);
  return problem;
}

const Register r{{.name = "internal_motor",
                  .summary = "a motor between two free wheels",
                  .variants = {"pulls", "reaches_its_speed"},
                  .build = build}};

}  // namespace
}  // namespace plumb::scenarios::internal_motor
