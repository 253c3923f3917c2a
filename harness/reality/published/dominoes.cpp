#include <algorithm>
#include <array>
#include <cmath>

#include "harness/reality/published/domino_row.h"
#include "harness/reality/published/published_law.h"

// A row of dominoes topples at a steady speed, here divided by sqrt(g h). Sources: measurements of dominoes
// of 48 mm x 7.5 mm with gaps of 1, 2 and 3 thicknesses, 0.877, 0.867 and 0.859 m/s to 1 % (J. Wang, advanced
// laboratory, 2026, github.com/JWang1414/winter2026code); the closed model of van Leeuwen, Am. J. Phys. 78
// (2010) 721, with friction 0.25 between dominoes. The band contains both, with 3 % on either side. The
// dominoes are ten times as large, because some engines have tolerances of a centimetre; the laws contain no
// length of their own.
namespace plumb::harness::reality {
namespace {
constexpr double kScale = 10, kHeight = 0.048 * kScale, kThick = 0.0075 * kScale;  // m
constexpr double kFriction = 0.25, kFloorFriction = 9;  // the geometric mean at the feet is 1.5: none slips
constexpr double kPush = 3;                             // rad/s
/// Shift of a block along the row at a start, m: a thousandth of its thickness.
constexpr double kShift = 1e-3 * kThick;
constexpr int kCount = 26, kFrom = 10, kTo = 20;

double speed_over(std::span<const Sample> samples, double gap, double dt) {
  const double passed = std::asin(gap / kHeight) / 2;  // half of its rotation until it touches the next
  std::array<double, 2> times{};
  for (std::size_t k = 0; k < times.size(); ++k) {
    const std::size_t body = 1 + static_cast<std::size_t>(k == 0 ? kFrom : kTo);
    for (std::size_t i = 1; i < samples.size() && times[k] == 0; ++i) {
      const double before = -samples[i - 1][body].angle, now = -samples[i][body].angle;
      if (now < passed) continue;
      times[k] = dt * (static_cast<double>(i) - (now - passed) / (now - before));
    }
  }
  if (times[1] == 0) return 0;  // the wave has stopped
  return (kTo - kFrom) * (gap + kThick) / (times[1] - times[0]) / std::sqrt(9.81 * kHeight);
}

PublishedLaw row(int thicknesses, double measured) {
  const double gap = thicknesses * kThick, model = toppling_speed({kHeight, kThick, gap, kFriction});
  const double modelled = model / std::sqrt(9.81 * kHeight), seen = measured / std::sqrt(9.81 * 0.048);
  const std::string name = "dominoes[" + std::to_string(thicknesses) + "]";
  const auto scene_with = [&](const std::function<double()>& shift) {
    Scene scene{.name = name};
    scene.gravity = {0, -9.81};
    scene.bodies = {fixed_box("floor", {0, -0.5}, {40, 1}, kFloorFriction)};
    for (int i = 0; i < kCount; ++i) {
      Body block{.name = "domino" + std::to_string(i),
                 .position = {i * (gap + kThick) + kShift * shift(), kHeight / 2}};
      block.shapes = {{.geometry = Box{kThick, kHeight}, .friction = kFriction}};
      scene.bodies.push_back(block);
    }
    Body& first = scene.bodies[1];  // turns about its front foot
    first.angular_velocity = -kPush;
    first.velocity = {kPush * kHeight / 2, kPush * kThick / 2};
    return scene;
  };
  const double dt = 1.0 / 240, duration = 4;
  return {name,
          "speed over sqrt(g h)",
          "Wang 2026, measured; van Leeuwen 2010",
          0.97 * std::min(modelled, seen),
          1.03 * std::max(modelled, seen),
          starts_of(scene_with),
          duration,
          dt,
          [gap, dt](std::span<const Sample> samples) { return speed_over(samples, gap, dt); }};
}
}  // namespace

std::vector<PublishedLaw> dominoes() { return {row(1, 0.877), row(2, 0.867), row(3, 0.859)}; }
}  // namespace plumb::harness::reality
