#include <cmath>

#include "scenarios/truth/parts.h"
#include "scenarios/truth/set_up.h"

// A rod that falls without rotation, at the angle a, lands on one end. With r the vector from its centre to
// that end, J = (1 + e) m v/(1 + r_x^2 m/I), which is (1 + e) m v/(1 + 3 cos^2 a) for a thin rod. Source:
// Newton's restitution; e.g. Kleppner and Kolenkow, ch. 6.
namespace plumb::scenarios::rod_lands {
namespace {
using namespace truth;

constexpr double kAngle = 0.3, kRestitution = 0.5, kLength = 1, kThick = 0.1, kDrop = 0.2;  // SI

Problem build(std::string_view, int) {
  Problem problem{.scene = scene_of("rod_lands"), .duration = 0.27};
  const Vec2<Real> end = turned(kAngle, {-kLength / Real(2), -kThick / Real(2)});
  const Shape shape = solid(Box{kLength, kThick}, 0, kRestitution);
  problem.scene.bodies = {
      ground(0, kRestitution),
      piece("rod", {0, kDrop - set_up::turned(kAngle, {-kLength / 2, -kThick / 2}).y}, shape, 2)};
  problem.scene.bodies[1].angle = kAngle;
  const Real at = std::sqrt(2 * Real(kDrop) / kGravity);
  const Real inertia = (Real(kLength) * kLength + Real(kThick) * kThick) / 12;  // over the mass
  const Real impulse = (1 + Real(kRestitution)) * kGravity * at / (1 + end.x * end.x / inertia);
  problem.truth = one_impact(problem.scene, "J = (1 + e) m v/(1 + r_x^2 m/I) (Newton)", at,
                             {{{0, impulse}, end.x * impulse / inertia}});
  problem.precise = within(1e-10);
  return problem;
}

const Register r{{.name = "rod_lands", .summary = "a tilted rod falls on one of its ends", .build = build}};

}  // namespace
}  // namespace plumb::scenarios::rod_lands
