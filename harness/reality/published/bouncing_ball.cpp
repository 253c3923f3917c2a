#include <algorithm>
#include <cmath>

#include "harness/reality/published/published_law.h"

// Drops a ball of measured restitution and measures the height of its rebound. Sources: International Tennis
// Federation, Rules of Tennis, appendix I (2.54 m, 1.35 to 1.47 m on a rigid floor); International Table
// Tennis Federation, leaflet T3 (305 mm, 240 to 260 mm on a steel block). The restitution is that of the
// middle of the band.
namespace plumb::harness::reality {
namespace {
PublishedLaw ball(const char* name, const char* source, double radius, double drop, double low, double high) {
  const std::string full_name = std::string("bouncing_ball[") + name + "]";
  const auto scene_with = [&](const std::function<double()>& shift) {
    Scene scene{.name = full_name};
    scene.gravity = {0, -9.81};
    // Heights are those of the ball's lowest point, known to a thousandth.
    Body ball{.name = "ball", .position = {0, (1 + 1e-3 * shift()) * drop + radius}};
    ball.shapes = {{.geometry = Circle{radius}, .restitution = std::sqrt((low + high) / 2 / drop)}};
    scene.bodies = {fixed_box("floor", {0, -0.5}, {20, 1}, 0), ball};
    return scene;
  };
  const auto rebound = [radius](std::span<const Sample> samples) {
    double most = 0;
    for (std::size_t i = 1; i < samples.size(); ++i)  // from when it first rises
      if (most > 0 || samples[i][1].position.y > samples[i - 1][1].position.y)
        most = std::max(most, samples[i][1].position.y - radius);
    return most;
  };
  const double fall = std::sqrt(2 * drop / 9.81);
  return {full_name, "height of the rebound, m", source,     low,
          high,      starts_of(scene_with),      1.9 * fall, 1.0 / 240,
          rebound};
}
}  // namespace

std::vector<PublishedLaw> bouncing_ball() {
  return {ball("tennis", "ITF, Rules of Tennis, appendix I", 0.033, 2.54, 1.35, 1.47),
          ball("table_tennis", "ITTF, leaflet T3", 0.02, 0.305, 0.24, 0.26)};
}
}  // namespace plumb::harness::reality
