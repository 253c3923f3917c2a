#include "extremes/parts/ramp.h"

#include <cmath>
#include <utility>

namespace plumb::extremes {

Trial on_a_slope(std::string name, const Geometry& geometry, double height, double friction,
                 double acceleration) {
  const Vec2d up{std::cos(kSlope), std::sin(kSlope)}, normal = perpendicular(up);
  Trial trial{.scene = {.name = std::move(name)}, .stretches = evenly(60, 60)};
  trial.scene.bodies = {{.name = "body",
                         .position = height * normal,
                         .angle = kSlope,
                         .shapes = {{.geometry = geometry, .friction = friction}}},
                        {.name = "slope",
                         .type = BodyType::Static,
                         .position = -0.5 * normal,
                         .angle = kSlope,
                         .shapes = {{.geometry = Box{20, 1}, .friction = friction}}}};
  const bool rolls = std::holds_alternative<Circle>(geometry);
  // A disc on which friction F acts rotates with F r/I. F/m is g sin minus the acceleration, and I = m r^2/2.
  const double pull = kGravity * std::sin(kSlope), turn = rolls ? 2 * (pull - acceleration) / height : 0;
  trial.exact = [=, start = trial.scene.bodies](double t, std::span<BodyState> out) {
    out[0] = initial_state(start[0]);
    out[0].position += -acceleration * t * t / 2 * up;
    out[0].velocity = -acceleration * t * up;
    out[0].angle += turn * t * t / 2;
    out[0].angular_velocity = turn * t;
    out[1] = initial_state(start[1]);
  };
  trial.judge = [exact = trial.exact, pull](const Scene& scene) {
    return judge_by({off_the_path(scene, exact, 0.05 * pull / 2, 100), deepest_overlap(scene, 0.01)});
  };
  return trial;
}

}  // namespace plumb::extremes
