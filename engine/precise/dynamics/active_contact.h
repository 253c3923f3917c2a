#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "engine/joints/row.h"
#include "engine/precise/dynamics/feature_shape.h"

namespace plumb::precise {

/// A persistent contact: one or two points of the same two shapes, with a common tangent.
struct ActiveContact {
  const FeatureShape* a = nullptr;
  const FeatureShape* b = nullptr;
  double friction = 0;          ///< static coefficient, up to which the contact sticks
  double sliding_friction = 0;  ///< kinetic: while it slips
  int mode = 0;  ///< contact mode, 0: sticks; +1, -1: slips in this direction, friction acts against it
  int count = 0;
  Feature features[2] = {};
  /// Forces when the contact mode was decided, N: of each point, and tangential while it sticks. If statics
  /// does not determine the forces, because there are more contacts than needed, the forces are these plus
  /// the smallest changes that the motion requires, so that they do not jump.
  double normal_forces[2] = {}, tangential_force = 0;

  bool sticks() const { return friction > 0 && mode == 0; }
  bool slides() const { return sliding_friction > 0 && mode != 0; }
};

/// Forces of persistent contacts, N: normal ones by point, patch after patch; tangential ones by patch, on
/// body b along the tangent (the normal from a to b turned a quarter counter-clockwise).
struct ContactForces {
  std::vector<double> normal, tangent;
  std::vector<double> limit_motor;  ///< of held limits and of motors at their speed, N or N m, in order
};

/// Returns J v of one row; `motion` by body.
inline double rate_along(const Row<double>& row, std::span<const Twist<double>> motion) {
  const auto part = [&](int body, Vec2d linear, double angular) {
    if (body == kFixedFrame) return 0.0;
    return dot(linear, motion[body].velocity) + angular * motion[body].angular_velocity;
  };
  return part(row.a, row.linear_a, row.angular_a) + part(row.b, row.linear_b, row.angular_b);
}

/// Rows and the velocity changes by a unit impulse along each of them, joints included.
struct ContactResponse {
  std::vector<Row<double>> rows;
  std::vector<Twist<double>> of_a, of_b;  ///< by row: of the row's own bodies
  std::vector<Twist<double>> all;         ///< row after row, by body; empty if joints transmit nothing

  Twist<double> at(std::size_t row, int body, std::size_t bodies) const {
    if (body == kFixedFrame) return {};
    if (!all.empty()) return all[row * bodies + static_cast<std::size_t>(body)];
    if (rows[row].a == body) return of_a[row];
    if (rows[row].b == body) return of_b[row];
    return {};
  }
};

}  // namespace plumb::precise
