#include <algorithm>
#include <cmath>

#include "scenarios/truth/billiard.h"
#include "scenarios/truth/colliding_discs.h"

// Discs collide in free space. The velocities after an impact depend only on masses, restitution and the
// normal at the moment of contact; head-on v1' = (m1 - m2)/(m1 + m2) v and v2' = 2 m1/(m1 + m2) v.
namespace plumb::scenarios::elastic_collision {
namespace {
using namespace truth;

Problem build(std::string_view variant, int) {
  Problem problem{.scene = scene_of("elastic_collision", variant, 0), .duration = 2};
  problem.scene.bodies = colliding_discs(variant);
  problem.truth = billiard_truth(problem.scene, 2);
  problem.conserved = {!variant.starts_with("restitution"), true, true, true};
  // Head-on the normal is constant, so only rounding errors remain; off-centre it depends on the time.
  double fastest = 0;
  for (const Body& body : problem.scene.bodies)
    fastest = std::max(fastest, std::hypot(body.velocity.x, body.velocity.y));
  const double digits = variant.starts_with("head_on") || variant == "cradle" ? 1e-13 : 1e-12;
  problem.precise = {2e-12 * fastest, 1e-12, digits * fastest, 1e-12, digits, digits, 1e-12};
  problem.precise.penetration = 1e-10;
  // Paths are straight, so a method that places impacts within the substep has no discretisation error.
  problem.second_order = {0, 0, 0, 0, 0, 0, 0};
  return problem;
}

const Register r{{.name = "elastic_collision",
                  .summary = "discs that collide: mass ratios, off-centre, restitution, Newton's cradle",
                  .variants = {"head_on_1", "head_on_10", "head_on_1000", "head_on_1e6", "oblique",
                               "restitution_0", "restitution_half", "cradle"},
                  .build = build}};

}  // namespace
}  // namespace plumb::scenarios::elastic_collision
