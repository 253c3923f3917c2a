#pragma once

#include "engine/math/small_turn.h"
#include "engine/world/contact_solver/body_motion.h"

namespace plumb {

/// Updates a position by h times the change of velocity since `velocity_before` and `spin_before`
/// (position-based dynamics).
template <class Real>
void follow(BodyMotion<Real>& motion, Rotation<Real>& rotation, Vec2<Real> velocity_before, Real spin_before,
            Real h) {
  motion.moved += h * (motion.velocity - velocity_before);
  const Real turn = h * (motion.angular_velocity - spin_before);
  if (turn == 0) return;
  motion.turned += turn;
  rotation = turned_by(rotation, turn);
}

}  // namespace plumb
