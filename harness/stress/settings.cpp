#include "harness/stress/settings.h"

#include <string_view>

namespace plumb::harness::stress {
namespace {

struct Row {
  std::string_view engine;
  Setting setting;
};

const std::vector<Row>& table() {
  static const Setting world{.name = "careful", .summary = "four times the substeps", .substeps = 16};
  static const Setting direct{
      .name = "direct", .summary = "direct solve of islands with joints", .options = {{"solver", "direct"}}};
  static const Setting bullet{.name = "careful",
                              .summary = "a quarter of the step, four times the iterations",
                              .substeps = 4,
                              .options = {{"iterations", "40"}}};
  static const Setting quarter{.name = "careful", .summary = "a quarter of the step", .substeps = 4};
  static const std::vector<Row> rows{
      {"plumb", world},
      {"plumb", direct},
      {"plumb-float", world},
      {"plumb-float", direct},
      {"plumb-precise",
       {.name = "loose",
        .summary = "a tolerance of 3e-4, for scenes that are too stiff for a smaller one",
        .tolerance = 3e-4}},
      {"plumb-precise",
       {.name = "symplectic",
        .summary = "a symplectic method with a fixed step, for long runs",
        .options = {{"method", "symplectic"}}}},
      {"box2d",
       {.name = "careful",
        .summary = "a quarter of the step, four times the iterations",
        .substeps = 4,
        .options = {{"velocity_iterations", "32"}, {"position_iterations", "12"}}}},
      {"bullet", bullet},
      {"bullet-double", bullet},
      {"bullet-multibody", quarter},
      {"mujoco", quarter},
  };
  return rows;
}

}  // namespace

reference::StepSettings Setting::with(double dt) const {
  return {.dt = dt, .substeps = substeps, .tolerance = tolerance, .options = options};
}

std::vector<Setting> settings_of(const reference::Backend& backend) {
  std::vector<Setting> out{{.name = "default", .summary = "the engine's defaults"}};
  for (const Row& row : table())
    if (row.engine == backend.name()) out.push_back(row.setting);
  return out;
}

}  // namespace plumb::harness::stress
