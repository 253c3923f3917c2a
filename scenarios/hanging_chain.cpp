#include "engine/math/arc_tangent.h"
#include "scenarios/truth/parts.h"
#include "scenarios/truth/set_up.h"

// A chain of N equal uniform links hangs at rest between two points: tan(phi_k) = (W/H)(k - (N + 1)/2), W a
// link's weight, H the tension sideways. Source: moments about the ends of each link.
namespace plumb::scenarios::hanging_chain {
namespace {
using namespace truth;

Problem build(std::string_view, int count) {
  Problem problem{.scene = scene_of("hanging_chain", count), .duration = 1};
  Vec2d end{};
  std::string before(kWorld);
  for (int k = 1; k <= count; ++k) {
    const double angle = arc_tangent(0.4 * (k - (count + 1) / 2.0), 1);
    const Vec2d half = 0.5 * set_up::direction(angle);
    Body link = piece("link" + std::to_string(k), end + half, untouchable(Box{1, 0.1}));
    link.angle = angle;
    problem.scene.joints.push_back(hinge(before, {k == 1 ? 0 : 0.5, 0}, link.name, {-0.5, 0}));
    problem.scene.bodies.push_back(link);
    before = link.name;
    end += 2.0 * half;
  }
  problem.scene.joints.push_back(hinge(before, {0.5, 0}, kWorld, end));
  problem.truth = equilibrium(problem.scene, "tan(phi_k) = (W/H)(k - (N + 1)/2)");
  problem.conserved = {.energy = true};
  problem.precise = within(1e-10);
  return problem;
}

const Register r{{.name = "hanging_chain",
                  .summary = "N links hang at rest between two points",
                  .sizes = {2, 7},
                  .scales = true,
                  .build = build}};

}  // namespace
}  // namespace plumb::scenarios::hanging_chain
