#pragma once

#include "engine/math/small_rotation.h"
#include "engine/world/contact_solver/solver_body.h"

namespace plumb {

/// Updates a position by h times the change of velocity since `velocity_before` and `spin_before`
/// (position-based dynamics).
template <class Real>
void move_by_velocity_change(SolverBody<Real>& motion, Rotation<Real>& rotation, Vec2<Real> velocity_before,
                             Real spin_before, Real h) {
  motion.delta_position += h * (motion.velocity - velocity_before);
  const Real delta_angle = h * (motion.angular_velocity - spin_before);
  if (delta_angle == 0) return;
  motion.delta_angle += delta_angle;
  rotation = rotated_by(rotation, delta_angle);
}

}  // namespace plumb
