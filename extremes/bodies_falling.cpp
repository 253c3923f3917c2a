#include "extremes/parts/scenes.h"

namespace plumb::extremes {
namespace {

constexpr int kSteps = 30;

Trial build(double bodies) {
  Trial trial{.scene = {.name = "bodies_falling"}, .stretches = {{3, kSteps / 3}}};
  const int count = static_cast<int>(bodies), row = static_cast<int>(std::ceil(std::sqrt(bodies)));
  for (int i = 0; i < count; ++i)
    trial.scene.bodies.push_back({.name = std::to_string(i),
                                  .position = {2.0 * (i % row), 2.0 * (i / row)},
                                  .shapes = {{.geometry = Circle{0.5}}}});
  const double time = kSteps * kDt, fall = kGravity * time * time / 2;
  trial.exact = [row](double t, std::span<BodyState> out) {
    for (std::size_t i = 0; i < out.size(); ++i) {
      const auto place = static_cast<int>(i);
      out[i] = {.position = {2.0 * (place % row), 2.0 * (place / row) - kGravity * t * t / 2},
                .velocity = {0, -kGravity * t}};
    }
  };
  trial.judge = [exact = trial.exact, fall](const Scene& scene) {
    return judge_by({off_the_path(scene, exact, fall / 20, 100)});
  };
  return trial;
}

const Register r{{.name = "bodies_falling",
                  .title = "discs of 1 m, 2 m apart, fall together for 30 steps",
                  .axis = "bodies",
                  .values = {100, 1e3, 1e4, 1e5, 1e6},
                  .usual = 100,
                  .rule = "position error at most 5 % of the height of the fall",
                  .patience = 3,
                  .build = build}};

}  // namespace
}  // namespace plumb::extremes
