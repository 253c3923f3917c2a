#include "extremes/parts/scenes.h"

namespace plumb::extremes {
namespace {

constexpr double kStart = 0.1, kRest = 1;  // m

Trial build(double turn) {
  const double w = turn / kDt;
  Trial trial{.scene = {.name = "spring_force", .gravity = {}}, .stretches = evenly(60, 60)};
  trial.scene.bodies = {
      {.name = "mass", .position = {kStart, 0}, .mass = 1, .shapes = {untouchable(Circle{0.05})}}};
  trial.scene.forces = {SpringForce{.body_a = std::string(kWorld),
                                    .body_b = "mass",
                                    .anchor_a = {-kRest, 0},
                                    .rest_length = kRest,
                                    .stiffness = w * w}};
  trial.exact = [=](double t, std::span<BodyState> out) {
    out[0] = {.position = {kStart * std::cos(w * t), 0}, .velocity = {-kStart * w * std::sin(w * t), 0}};
  };
  trial.judge = [=](const Scene& scene) {
    const double energy = kStart * kStart * w * w / 2;
    return judge_by({energy_gained(scene, energy, 0.05), energy_lost(scene, energy, 0.05)});
  };
  return trial;
}

const Register r{{.name = "spring_force",
                  .title = "a mass swings on a spring without damping for 1 s",
                  .axis = "frequency times dt",
                  .values = {0.01, 0.1, 0.5, 1, 2, 5, 10, 100, 1e3, 1e4},
                  .usual = 0.1,
                  .rule = "energy error at most 5 %",
                  .build = build}};

}  // namespace
}  // namespace plumb::extremes
