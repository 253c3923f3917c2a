#pragma once

#include <optional>

#include "engine/scene/formula.h"
#include "engine/scene/scene.h"

namespace plumb {

/// The path of a body with a prescribed motion, as functions of time.
class PrescribedPath {
 public:
  /// Throws `std::invalid_argument` if a formula is invalid.
  explicit PrescribedPath(const Body& body);

  struct Point {
    BodyState state{};
    Vec2d acceleration{};             ///< m/s^2
    double angular_acceleration = 0;  ///< rad/s^2
  };
  /// Returns the motion at time `t`, s: velocities and accelerations are the formulas' derivatives.
  Point at(double t) const;

 private:
  std::optional<Formula> x_, y_, angle_;
  BodyState start_;  // velocities of coordinates without a formula, which are constant
};

}  // namespace plumb
