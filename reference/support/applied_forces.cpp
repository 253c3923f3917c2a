#include "reference/support/applied_forces.h"

#include "engine/math/trigonometry.h"

namespace plumb::reference {

AppliedForces::AppliedForces(const Scene& scene)
    : laws_(scene),
      poses_(scene.bodies.size()),
      twists_(scene.bodies.size()),
      wrenches_(scene.bodies.size()) {
  for (std::size_t body = 0; body < scene.bodies.size(); ++body)
    if (laws_.acts_on(body)) bodies_.push_back(body);
}

void AppliedForces::place(std::size_t body, const BodyState& state) {
  poses_[body] = {state.position, rotation_of(state.angle)};
  twists_[body] = {state.velocity, state.angular_velocity};
  wrenches_[body] = {};
}

}  // namespace plumb::reference
