// Steps a scene that uses a feature, one that does not, or both side by side, for a counter of instructions:
//
//     plumb_features                              the engines and the features, one per line
//     plumb_features ENGINE PART [FEATURE] STEPS  PART: empty, rest, declared, feature or both
//
// The instructions to count are those of the function `plumb_measured_steps`.
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <stdexcept>
#include <string>
#include <vector>

#include "bench/features/scenes.h"
#include "reference/backend.h"

extern "C" __attribute__((noinline)) void plumb_measured_steps(plumb::reference::Simulator& simulator,
                                                               int steps) {
  simulator.advance(steps);
}

namespace plumb::bench {
namespace {

constexpr int kWarm = 8;  // steps before counting: the first ones find pairs and allocate memory

void list() {
  for (const char* engine : {"plumb", "plumb-float"}) std::printf("engine %s\n", engine);
  for (const Feature& feature : features())
    std::printf("feature %s %s %s\n", std::string(feature.name).c_str(),
                feature.declare != nullptr ? "declared" : "-", std::string(feature.what).c_str());
}

Scene scene_of(const std::string& part, const std::string& name) {
  Scene scene;
  scene.name = "features";
  const Feature* chosen = nullptr;
  for (const Feature& feature : features())
    if (feature.name == name) chosen = &feature;
  if (part == "empty") return scene;
  if (part != "rest" && chosen == nullptr) throw std::runtime_error("there is no feature '" + name + "'");
  if (part == "feature" || part == "both") chosen->add(scene);
  if (part == "rest" || part == "both") add_rest(scene, nullptr);
  if (part == "declared") add_rest(scene, chosen);
  return scene;
}

int run(const std::vector<std::string>& arguments) {
  if (arguments.empty()) {
    list();
    return 0;
  }
  if (arguments.size() < 3) throw std::runtime_error("usage: plumb_features ENGINE PART [FEATURE] STEPS");
  const Scene scene = scene_of(arguments[1], arguments.size() > 3 ? arguments[2] : "");
  const reference::Backend& engine = reference::find_backend(arguments[0]);
  if (const std::string reason = engine.unsupported(scene, {}); !reason.empty()) {
    std::printf("skipped: %s\n", reason.c_str());
    return 0;
  }
  const auto simulator = engine.create(scene, {});
  simulator->advance(kWarm);
  plumb_measured_steps(*simulator, std::atoi(arguments.back().c_str()));
  return 0;
}

}  // namespace
}  // namespace plumb::bench

int main(int argc, char** argv) {
  try {
    return plumb::bench::run({argv + 1, argv + argc});
  } catch (const std::exception& error) {
    std::fprintf(stderr, "plumb_features: %s\n", error.what());
    return 2;
  }
}
