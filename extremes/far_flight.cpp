#include "extremes/parts/scenes.h"

namespace plumb::extremes {
namespace {

constexpr Vec2d kThrow{3, 4};  // m/s

Trial build(double distance) {
  const Vec2d start{distance, distance};
  Trial trial{.scene = {.name = "far_flight"}, .stretches = evenly(60, 60)};
  trial.scene.bodies = {
      {.name = "ball", .position = start, .velocity = kThrow, .shapes = {untouchable(Circle{0.5})}}};
  trial.exact = [=](double t, std::span<BodyState> out) {
    out[0] = {.position = start + t * kThrow - Vec2d{0, kGravity * t * t / 2},
              .velocity = kThrow - Vec2d{0, kGravity * t}};
  };
  trial.judge = [exact = trial.exact](const Scene& scene) {
    return judge_by({off_the_path(scene, exact, 0.05 * kGravity / 2, 100)});
  };
  return trial;
}

const Register r{{.name = "far_flight",
                  .title = "a ball is thrown at 5 m/s and flies for 1 s, far from the origin along x and y",
                  .axis = "distance from the origin",
                  .unit = "m",
                  .values = {0, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9},
                  .usual = 0,
                  .rule = "position error at most 0.25 m, 5 % of the height of the fall",
                  .build = build}};

}  // namespace
}  // namespace plumb::extremes
