#include <algorithm>

#include "scenarios/truth/parts.h"

// A torque acts for a limited time on a disc and on a box: the angular velocity grows at T/I, and is constant
// afterwards. Source: Euler.
namespace plumb::scenarios::torque_pulse {
namespace {
using namespace truth;

constexpr double kTorque = 1.5, kFrom = 0.25, kFor = 0.5;  // N m, s, s

Problem build(std::string_view, int) {
  Problem problem{.scene = scene_of("torque_pulse", "", 0), .duration = 1.5};
  problem.scene.bodies = {thrown(piece("disc", {-1, 0}, untouchable(Circle{0.4}), 3), {0.5, 1}, -2),
                          piece("box", {1, 0}, untouchable(Box{0.8, 0.3}), 2)};
  problem.scene.forces = {Torque{"disc", kTorque, kFrom, kFor}, Torque{"box", -kTorque, kFrom, kFor}};
  const Real disc = 3 * 0.4L * 0.4L / 2, box = 2 * (0.8L * 0.8L + 0.3L * 0.3L) / 12;
  const auto path = [=](Real t, Moving moving) {
    const Real acts = std::clamp<Real>(t - kFrom, 0, kFor), after = std::max<Real>(t - kFrom - kFor, 0);
    for (Motion& m : moving) m = coast(m, std::min<Real>(t, kFrom));
    moving[0] = coast(coast(moving[0], acts, {{}, kTorque / disc}), after);
    moving[1] = coast(coast(moving[1], acts, {{}, -kTorque / box}), after);
  };
  problem.truth = follow(problem.scene, "spin T t/I, I = m r^2/2 and m (w^2 + h^2)/12 (Euler)", path);
  problem.conserved = {.momentum_x = true, .momentum_y = true};
  problem.precise = within(1e-10);
  return problem;
}

const Register r{{.name = "torque_pulse",
                  .summary = "a torque acts on a disc and a box for a limited time",
                  .build = build}};

}  // namespace
}  // namespace plumb::scenarios::torque_pulse
