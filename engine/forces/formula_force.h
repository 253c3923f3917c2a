#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "engine/forces/wrench.h"
#include "engine/joints/row.h"
#include "engine/math/arc_tangent.h"
#include "engine/scene/formula.h"

namespace plumb {

/// Force and torque by formulas in the time and the body's state (`kForceVariables`).
struct FormulaForceLaw {
  std::size_t body = 0;
  Vec2d point{};    ///< m, in the body's frame
  double mass = 0;  ///< kg
  Formula x{}, y{}, torque{};

  using Variables = std::array<double, 8>;

  /// Returns the values of the formulas' variables.
  Variables variables(double time, const Pose<double>& pose, const Twist<double>& twist) const {
    const double angle = arc_tangent(pose.rotation.s, pose.rotation.c);
    return {time,
            pose.position.x,
            pose.position.y,
            angle,
            twist.velocity.x,
            twist.velocity.y,
            twist.angular_velocity,
            mass};
  }

  Wrench<double> wrench(double time, const Pose<double>& pose, const Twist<double>& twist) const {
    const Variables now = variables(time, pose, twist);
    const std::span<const double> values(now);
    const Vec2d force{x.at(values), y.at(values)};
    return {force, torque.at(values) + cross(pose.rotation * point, force)};
  }
};

}  // namespace plumb
