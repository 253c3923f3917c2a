#include "harness/thresholds/parts.h"

#include <cmath>
#include <utility>

#include "engine/math/trigonometry.h"

namespace plumb::harness::thresholds {

Body block(std::string name, double width, double height, Vec2d position, double friction, double angle) {
  return {.name = std::move(name),
          .position = position,
          .angle = angle,
          .mass = width * height,
          .shapes = {{.geometry = Box{width, height}, .friction = friction}}};
}

Body held(Body body) {
  body.type = BodyType::Static;
  return body;
}

Slope::Slope(double angle)
    : angle_(angle), uphill_(rotation_of(angle) * Vec2d{1, 0}), normal_(perpendicular(uphill_)) {}

Body Slope::ground(double friction) const {
  constexpr double kThickness = 2;
  return held(block("ground", 200, kThickness, at(0, -kThickness / 2), friction, angle_));
}

// Solves a/2 (T^2 - kSettled^2) = 2 `way` for T.
double time_to_slip(double way, double acceleration) {
  return std::sqrt(kSettled * kSettled + 4 * way / acceleration);
}

double time_to_tilt(double offset, double arm, double gyration_squared, double tilt) {
  const double rate = std::sqrt(kGravity * arm / gyration_squared);
  return 1.5 * std::acosh(1 + tilt * arm / offset) / rate;
}

}  // namespace plumb::harness::thresholds
