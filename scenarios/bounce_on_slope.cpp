#include "scenarios/truth/billiard.h"
#include "scenarios/truth/parts.h"

// Balls bounce down a smooth slope: the velocity along the slope grows as in free fall, the velocity across
// it bounces. Source: Galileo; Newton's restitution.
namespace plumb::scenarios::bounce_on_slope {
namespace {
using namespace truth;

constexpr double kTilt = 0.3, kRestitution = 0.8, kRadius = 0.2, kDuration = 1.5;  // rad, 1, m, s

Problem build(std::string_view, int) {
  Problem problem{.scene = scene_of("bounce_on_slope"), .duration = kDuration};
  const Shape ball = solid(Circle{kRadius}, 0, kRestitution);
  problem.scene.bodies = {ramp(kTilt, 0, kRestitution), piece("dropped", {0, 1.3}, ball),
                          piece("thrown", {-3, 2.1}, ball, 3)};
  problem.scene.bodies[2].velocity = {-1, 2};
  const Vec2<Real> along = direction(-Real(kTilt));
  problem.truth = billiard_truth(problem.scene, kDuration, {{{0, 0}, perpendicular(along)}});
  problem.precise = within(1e-10);
  return problem;
}

const Register r{{.name = "bounce_on_slope", .summary = "balls bounce down a slope", .build = build}};

}  // namespace
}  // namespace plumb::scenarios::bounce_on_slope
