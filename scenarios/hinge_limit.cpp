#include <cmath>

#include "scenarios/truth/parts.h"
#include "scenarios/truth/phases.h"

// A rod falls from the horizontal about its end until it reaches its hinge's limit, which stops it at once.
// Source: the pendulum, q'' = -(3 g/(2 L)) cos q; a limit has no restitution.
namespace plumb::scenarios::hinge_limit {
namespace {
using namespace truth;

constexpr double kLength = 1, kLimit = -1;  // m, rad

Problem build(std::string_view, int) {
  Problem problem{.scene = scene_of("hinge_limit"), .duration = 1};
  problem.scene.bodies = {piece("rod", {kLength / 2, 0}, untouchable(Box{kLength, 0.05}), 2)};
  problem.scene.bodies[0].inertia = 2 * kLength * kLength / 12;
  RevoluteJoint joint = hinge(kWorld, {}, "rod", {-kLength / 2, 0});
  joint.limits = Range{kLimit, 1};
  problem.scene.joints = {joint};
  const auto law = [](Real q, Real) { return -3 * kGravity / (2 * Real(kLength)) * std::cos(q); };
  const Phase fall{second_order_law(law), [](const auto& y) { return y[0] - kLimit; },
                   [](const auto&) {
                     return Trajectory::State{kLimit, 0};
                   }};
  const Phases path({0, 0}, {fall, {second_order_law([](Real, Real) { return Real(0); })}}, problem.duration);
  problem.truth =
      turning_truth(problem.scene, "a pendulum until the limit, then rest", path, {}, {kLength / 2, 0});
  problem.precise = within(1e-9);
  return problem;
}

const Register r{{.name = "hinge_limit", .summary = "a rod falls until its hinge stops it", .build = build}};

}  // namespace
}  // namespace plumb::scenarios::hinge_limit
