#include <algorithm>
#include <cmath>

#include "harness/reality/published/published_law.h"

// A slender block is tilted and released: each change of corner leaves (1 - 1.5 sin(alpha)^2)^2 of its
// energy. Source: Housner, Bull. Seismol. Soc. Am. 53 (1963) 403, by angular momentum; 2 % of the angle on
// either side.
namespace plumb::harness::reality {
namespace {
constexpr double kWidth = 0.2, kHeight = 0.8, kFriction = 0.8;  // m
constexpr double kShare = 0.6;  // initial tilt, as a fraction of that at which it topples

double first_turn(std::span<const Sample> samples) {
  double most = 0;  // the tilt on the other side at which it turns back
  for (const Sample& sample : samples) {
    if (most > 0.01 && sample[1].angle < most) break;
    most = std::max(most, sample[1].angle);
  }
  return most;
}
}  // namespace

std::vector<PublishedLaw> rocking_block() {
  const double alpha = std::atan(kWidth / kHeight), tilt = kShare * alpha,
               reach = std::hypot(kWidth, kHeight) / 2;
  const double kept = std::pow(1 - 1.5 * std::pow(std::sin(alpha), 2), 2);
  const double raised = kept * (std::cos(alpha - tilt) - std::cos(alpha));  // height over that distance
  const double turn = alpha - std::acos(std::cos(alpha) + raised);
  const auto scene_with = [&](const std::function<double()>& shift) {
    const double at = tilt + 1e-3 * tilt * shift();
    Body block{.name = "block", .angle = -at};  // while it stands on the corner at the origin
    block.position = {-reach * std::sin(alpha - at), reach * std::cos(alpha - at)};
    block.shapes = {{.geometry = Box{kWidth, kHeight}, .friction = kFriction}};
    Scene scene{.name = "rocking_block"};
    scene.bodies = {fixed_box("floor", {0, -0.5}, {20, 1}, kFriction), block};
    return scene;
  };
  return {{"rocking_block", "tilt after a change of corner, rad", "Housner 1963", 0.98 * turn, 1.02 * turn,
           starts_of(scene_with), 1.5, 1.0 / 240, first_turn}};
}
}  // namespace plumb::harness::reality
