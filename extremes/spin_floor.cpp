#include "extremes/parts/scenes.h"

namespace plumb::extremes {
namespace {

Trial build(double rate) {
  Trial trial{.scene = {.name = "spin_floor"}, .stretches = evenly(60, 60)};
  trial.scene.bodies = {{.name = "disc",
                         .position = {0, 0.5},
                         .angular_velocity = rate,
                         .shapes = {{.geometry = Circle{0.5}, .friction = 0}}},
                        {.name = "floor",
                         .type = BodyType::Static,
                         .position = {0, -0.5},
                         .shapes = {{.geometry = Box{20, 1}, .friction = 0}}}};
  trial.exact = [=, start = trial.scene.bodies](double t, std::span<BodyState> out) {
    out[0] = initial_state(start[0]);
    out[0].angle = rate * t;
    out[1] = initial_state(start[1]);
  };
  trial.judge = [=](const Scene& scene) {
    return judge_by({wrong_angular_velocity(0, rate, 1e-3), farthest_from_start(scene, 0.01, 10)});
  };
  return trial;
}

const Register r{{.name = "spin_floor",
                  .title = "a disc of 1 m spins on a frictionless floor for 1 s",
                  .axis = "rate",
                  .unit = "rad/s",
                  .values = {1, 10, 100, 1e3, 1e4, 1e5, 1e6},
                  .rule = "angular velocity constant within 0.1 %, displacement at most 1 cm",
                  .build = build}};

}  // namespace
}  // namespace plumb::extremes
