#include "extremes/parts/scenes.h"

namespace plumb::extremes {
namespace {

// With critical damping, released at the rest length, the load sags by g/w^2 (1 - (1 + w t) e^(-w t)).
Trial build(double turn) {
  const double w = turn / kDt, settled = 20 / w;
  Trial trial{.scene = {.name = "spring_joint"}};
  trial.stretches = {{1, static_cast<int>(steps_for(settled, kDt))}, {60, 1}};
  trial.scene.bodies = {
      {.name = "load", .position = {0, -1}, .mass = 1, .shapes = {untouchable(Circle{0.05})}}};
  trial.scene.joints = {
      DistanceJoint{.name = "spring",
                    .body_a = std::string(kWorld),
                    .body_b = "load",
                    .length = 1,
                    .spring = Spring{.hertz = w / (2 * std::numbers::pi), .damping_ratio = 1}}};
  trial.exact = [=](double t, std::span<BodyState> out) {
    const double sag = kGravity / (w * w), fade = std::exp(-w * t);
    out[0] = {.position = {0, -1 - sag * (1 - (1 + w * t) * fade)}, .velocity = {0, -sag * w * w * t * fade}};
  };
  trial.judge = [exact = trial.exact, settled](const Scene& scene) {
    Rule rule = off_the_path(scene, exact, 0.01, 10);
    rule.figure = [figure = rule.figure, settled](double t, std::span<const BodyState> states) {
      return t < settled / 2 ? 0 : figure(t, states);
    };
    return judge_by({rule});
  };
  return trial;
}

const Register r{
    {.name = "spring_joint",
     .title = "a load hangs on a spring joint of critical damping, released at the spring's rest length",
     .axis = "frequency times dt",
     .values = {0.05, 0.1, 0.5, 1, 2, 5, 10, 100, 1e3, 1e4},
     .usual = 0.1,
     .rule = "position error at most 1 cm after 20 time constants 1/w",
     .build = build}};

}  // namespace
}  // namespace plumb::extremes
