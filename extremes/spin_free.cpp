#include "extremes/parts/scenes.h"

namespace plumb::extremes {
namespace {

Trial build(double rate) {
  Trial trial{.scene = {.name = "spin_free", .gravity = {}}, .stretches = evenly(60, 60)};
  trial.scene.bodies = {{.name = "box", .angular_velocity = rate, .shapes = {untouchable(Box{1, 0.5})}}};
  trial.exact = [=](double t, std::span<BodyState> out) {
    out[0] = {.angle = rate * t, .angular_velocity = rate};
  };
  trial.judge = [=](const Scene& scene) {
    return judge_by({wrong_angular_velocity(0, rate, 1e-3), farthest_from_start(scene, 0.01, 10)});
  };
  return trial;
}

const Register r{{.name = "spin_free",
                  .title = "a box spins freely for 1 s",
                  .axis = "rate",
                  .unit = "rad/s",
                  .values = {1, 10, 100, 1e3, 1e4, 1e5, 1e6},
                  .rule = "angular velocity constant within 0.1 %, displacement at most 1 cm",
                  .build = build}};

}  // namespace
}  // namespace plumb::extremes
