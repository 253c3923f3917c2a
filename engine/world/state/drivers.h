#pragma once

#include "engine/world/world_data.h"

namespace plumb {

/// Returns true if a body moves others with whatever force it takes: a kinematic one that moves.
template <class Real>
bool is_driver(const WorldData<Real>& w, int body) {
  const SolverBody<Real>& motion = w.motion[body];
  return w.bodies[body].type == BodyType::Kinematic &&
         (motion.velocity.x != 0 || motion.velocity.y != 0 || motion.angular_velocity != 0);
}

}  // namespace plumb
