#include "extremes/parts/scenes.h"

namespace plumb::extremes {
namespace {

Trial build(double bodies) {
  Trial trial{.scene = {.name = "bodies_resting"}, .stretches = {{3, 4}}};
  const int count = static_cast<int>(bodies), row = static_cast<int>(std::ceil(std::sqrt(bodies)));
  const double height = 3, width = 1.5 * row;
  for (int i = 0; i < (count + row - 1) / row; ++i)
    trial.scene.bodies.push_back({.name = "floor" + std::to_string(i),
                                  .type = BodyType::Static,
                                  .position = {width / 2, height * i - 0.5},
                                  .shapes = {{.geometry = Box{width + 4, 1}}}});
  for (int i = 0; i < count; ++i)
    trial.scene.bodies.push_back({.name = std::to_string(i),
                                  .position = {1.5 * (i % row), height * (i / row) + 0.5},
                                  .shapes = {{.geometry = Box{1, 1}}}});
  trial.exact = at_rest(trial.scene);
  trial.judge = [](const Scene& scene) { return judge_by({farthest_from_start(scene, 0.01, 10)}); };
  return trial;
}

const Register r{{.name = "bodies_resting",
                  .title = "boxes of 1 m, 0.5 m apart, rest on floors above each other for 12 steps",
                  .axis = "bodies",
                  .values = {100, 1e3, 1e4, 1e5, 1e6},
                  .usual = 100,
                  .rule = "no box moves by more than 1 % of its side",
                  .patience = 3,
                  .build = build}};

}  // namespace
}  // namespace plumb::extremes
