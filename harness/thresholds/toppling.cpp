#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "harness/thresholds/catalogue.h"
#include "harness/thresholds/parts.h"

// A box of 1 m by 2 m tips about its lower corner when the line of its weight, or of the sum of its weight
// and a push, passes beside the corner. Source: moments about the corner, any mechanics text.
namespace plumb::harness::thresholds {
namespace {

constexpr double kWidth = 1, kHeight = 2, kFriction = 1;
constexpr double kHalfDiagonal = 1.118033988749895;                             // m
constexpr double kGyrationSquared = (kWidth * kWidth + kHeight * kHeight) / 3;  // m^2, about a corner
constexpr double kPushedAt = 1.5;                                               // m above the ground
constexpr double kDegree = std::numbers::pi / 180;
constexpr const char* kJudged =
    "the box tilts by more than 0.05 rad, within 1.5 times the time that a rigid box needs if it is beyond "
    "the limit by half a unit of the last digit";

// Fails once the last body, the box, has tilted.
auto tilted_from(double angle) {
  return [angle](double time, std::span<const BodyState> states) {
    const double tilt = std::abs(states.back().angle - angle);
    return tilt > kToppled ? fmt::format("tipped over within {:.2g} s", time) : std::string();
  };
}

Trial on_slope(double degrees, double resolution) {
  const Slope slope(degrees * kDegree);
  Trial trial{.scene = {.name = "toppling_angle", .gravity = {0, -kGravity}}};
  trial.scene.bodies = {slope.ground(kFriction),
                        block("box", kWidth, kHeight, slope.at(0, kHeight / 2), kFriction, slope.angle())};
  const double beyond = resolution / 2 * std::atan(kWidth / kHeight) * kHalfDiagonal;  // m
  trial.duration = time_to_tilt(beyond, kHalfDiagonal, kGyrationSquared, kToppled);
  trial.broke = tilted_from(slope.angle());
  return trial;
}

Trial pushed(double push, double resolution) {
  Trial trial{.scene = {.name = "toppling_push", .gravity = {0, -kGravity}}};
  Body box = block("box", kWidth, kHeight, {0, kHeight / 2}, kFriction);
  const double weight = box.mass * kGravity;
  trial.scene.bodies = {held(block("ground", 40, 2, {0, -1}, kFriction)), box};
  trial.scene.forces = {
      PointForce{.body = "box", .force = {push * weight, 0}, .point = {0, kPushedAt - kHeight / 2}}};
  // At this distance beside the corner, the weight's moment equals the excess of the push's moment. As the
  // box tilts, both arms change like that of a pendulum of half a diagonal.
  const double beyond = resolution / 2 * kWidth / 2;  // m
  trial.duration = time_to_tilt(beyond, kHalfDiagonal, kGyrationSquared, kToppled);
  trial.broke = tilted_from(0);
  return trial;
}

}  // namespace

Threshold toppling_angle() {
  return {.name = "toppling_angle",
          .title = "steepest slope for a box twice as high as wide",
          .quantity = "steepest slope on which a box twice as high as wide stands, friction 1",
          .unit = "degrees",
          .source = "tan(theta) = width / height",
          .judged = kJudged,
          .range = {.low = 15, .high = 40},
          .exact = exactly(std::atan(kWidth / kHeight) / kDegree),
          .build = on_slope};
}

Threshold toppling_push() {
  return {
      .name = "toppling_push",
      .title = "least push that tips a box over",
      .quantity =
          "largest horizontal push / weight, at a height of 1.5 m, under which a box of 1 m by 2 m stands",
      .source = "(width / 2) / height of the push",
      .judged = kJudged,
      .range = {.low = 0.15, .high = 0.6},
      .exact = exactly(kWidth / 2 / kPushedAt),
      .build = pushed};
}

}  // namespace plumb::harness::thresholds
