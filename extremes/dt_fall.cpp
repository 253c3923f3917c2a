#include <algorithm>

#include "extremes/parts/scenes.h"

namespace plumb::extremes {
namespace {

Trial build(double dt) {
  Trial trial{.scene = {.name = "dt_fall"}, .dt = dt};
  trial.scene.bodies = {{.name = "ball", .shapes = {untouchable(Circle{0.5})}}};
  const double time = std::max(1.0, 10 * dt), fall = kGravity * time * time / 2;
  trial.stretches = evenly(steps_for(time, dt), 100);
  trial.exact = [](double t, std::span<BodyState> out) {
    out[0] = {.position = {0, -kGravity * t * t / 2}, .velocity = {0, -kGravity * t}};
  };
  trial.judge = [exact = trial.exact, fall](const Scene& scene) {
    return judge_by(
        {off_the_path(scene, exact, fall / 20, 10 * fall), path_not_covered(scene, exact, fall / 4)});
  };
  return trial;
}

const Register r{{.name = "dt_fall",
                  .title = "a ball falls for 1 s, or for 10 steps if these take longer",
                  .axis = "dt",
                  .unit = "s",
                  .values = {1e-6, 1e-5, 1e-4, 1e-3, 1.0 / 60, 0.05, 0.2, 1},
                  .usual = 1.0 / 60,
                  .rule = "position error at most 5 % of the height of the fall (semi-implicit Euler in 10 "
                          "steps is off by 10 %)",
                  .build = build}};

}  // namespace
}  // namespace plumb::extremes
