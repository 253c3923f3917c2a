#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "harness/thresholds/catalogue.h"
#include "harness/thresholds/parts.h"

// A box on a slope stays if tan(theta) <= mu, and otherwise slides with g cos(theta) (tan(theta) - mu).
// Source: Coulomb's law, any mechanics text.
namespace plumb::harness::thresholds {
namespace {

// Displacement that counts as a slide. Creep of several mm/s does not reach it.
constexpr double kSlide = 0.1;  // m

Trial box_on_slope(double angle, double friction, double resolution) {
  const Slope slope(angle);
  Trial trial{.scene = {.name = "ramp_friction", .gravity = {0, -kGravity}}};
  trial.scene.bodies = {slope.ground(friction), block("box", 1, 0.5, slope.at(0, 0.25), friction, angle)};
  trial.duration = time_to_slip(kSlide, kGravity * std::sin(angle) * resolution / 2);
  trial.broke = [slope, settled = std::optional<double>()](double time,
                                                           std::span<const BodyState> states) mutable {
    const double along = slope.along(states[1].position);
    if (time < kSettled) return std::string();
    if (!settled) settled = along;
    const double slid = std::abs(along - *settled);
    return slid > kSlide ? fmt::format("slides {:.2g} m in {:.2g} s", slid, time - kSettled) : std::string();
  };
  return trial;
}

Threshold on_slope(std::string name, int degrees) {
  const double angle = degrees * std::numbers::pi / 180, exact = std::tan(angle);
  return {
      .name = std::move(name),
      .title = fmt::format("least friction that holds a box on a slope of {} degrees", degrees),
      .quantity =
          fmt::format("least friction coefficient that holds a box on a slope of {} degrees", degrees),
      .source = "tan(theta), Coulomb",
      .judged =
          "the box slides by more than 10 cm after the first second, within twice the time that a rigid box "
          "needs if its friction is too small by half a unit of the last digit",
      .range = {.low = 0.5 * exact, .high = 1.5 * exact, .holds_below = false},
      .exact = exactly(exact),
      .build = [angle](double value, double resolution) { return box_on_slope(angle, value, resolution); }};
}

}  // namespace

Threshold ramp_friction() { return on_slope("ramp_friction", 20); }
Threshold steep_ramp_friction() { return on_slope("steep_ramp_friction", 40); }

}  // namespace plumb::harness::thresholds
