// A recording of everything that is done to a world, and its replay.
#include <cstdio>
#include <filesystem>

#include "engine/world/recorder.h"
#include "engine/world/replay.h"

int main() {
  const std::filesystem::path file = std::filesystem::temp_directory_path() / "plumb_example.rec";
  {
    plumb::RecordedWorld<float> world(file);
    world.create_body({.type = plumb::BodyType::Static}, {.geometry = plumb::Box{20, 1}});
    for (int i = 0; i < 5; ++i)
      world.create_body({.name = "ball", .position = {0.3 * i, 2.0 + i}}, {.geometry = plumb::Circle{0.5}});
    for (int i = 0; i < 100; ++i) {
      if (i == 50) world.set_gravity({1, -9.81});
      world.step();
    }
    std::printf("recorded %lld steps\n", static_cast<long long>(world->step_count()));  // reading: through ->
  }
  const plumb::ReplayReport report = plumb::replay(file);
  if (report.first_difference) {
    std::printf("step %lld differs:", static_cast<long long>(*report.first_difference));
    for (const plumb::BodyDifference& each : report.bodies) std::printf(" %s", each.name.c_str());
  } else {
    std::printf("replayed %d calls, all steps are the same", report.calls);
  }
  std::printf("%s\n", report.message.c_str());
  std::filesystem::remove(file);
  return report.first_difference || report.steps != 100 ? 1 : 0;
}
