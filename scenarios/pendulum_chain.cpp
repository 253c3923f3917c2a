#include "scenarios/truth/parts.h"
#include "scenarios/truth/rod_chain.h"

// N uniform rods of 1 m and 1 kg, hinged end to end, laid along +x from a fixed pivot and released. Joint
// forces are large and the chain soon whips, which shows the errors of iterative joint solvers.
namespace plumb::scenarios::pendulum_chain {
namespace {
using namespace truth;

Problem build(std::string_view, int count) {
  Problem problem{.scene = scene_of("pendulum_chain", count), .duration = 1};
  for (int i = 0; i < count; ++i) {
    const std::string name = "rod" + std::to_string(i), before = "rod" + std::to_string(i - 1);
    problem.scene.bodies.push_back(piece(name, {i + 0.5, 0}, untouchable(Box{1, 0.05})));
    problem.scene.bodies.back().inertia = 1.0 / 12;
    const bool first = i == 0;
    RevoluteJoint joint = hinge(first ? kWorld : before, {first ? 0 : 0.5, 0}, name, {-0.5, 0});
    joint.name = "hinge" + std::to_string(i);
    problem.scene.joints.push_back(joint);
  }
  problem.truth = rod_chain_truth(count);
  problem.conserved = {.energy = true};
  // A mode of frequency w multiplies a position error by w in the velocity. The fastest mode of a hanging
  // chain has w^2 < 4 N g/L (the largest zero of a Laguerre polynomial).
  const double digits = rod_chain_digits(count), fastest = std::sqrt(4 * count * kGravity);
  problem.precise = {digits, 2 * digits, fastest * digits, 2 * fastest * digits, digits};
  problem.precise.joint_gap = 1e-10;
  return problem;
}

const Register r{{.name = "pendulum_chain",
                  .summary = "N hinged rods released from the horizontal",
                  .sizes = {1, 2, 5, 20, 100},
                  .scales = true,
                  .build = build}};

}  // namespace
}  // namespace plumb::scenarios::pendulum_chain
