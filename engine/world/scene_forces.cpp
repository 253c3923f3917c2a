#include "engine/world/scene_forces.h"

#include "engine/math/trigonometry.h"
#include "engine/world/law_bodies.h"

namespace plumb {

template <class Real>
SceneForces<Real>::SceneForces(const Scene& scene, const SceneParts& parts)
    : laws_(scene),
      ids_(parts.bodies),
      poses_(scene.bodies.size()),
      twists_(scene.bodies.size()),
      wrenches_(scene.bodies.size()) {
  for (std::size_t body = 0; body < scene.bodies.size(); ++body) {
    const bool dynamic = scene.bodies[body].type == BodyType::Dynamic;
    gravity_.push_back(dynamic ? scene.bodies[body].gravity_scale * scene.gravity : Vec2d{});
    if (laws_.acts_on(body)) acted_on_.push_back(body);
  }
}

template <class Real>
void SceneForces<Real>::place(const BasicWorld<Real>& world) {
  for (const std::size_t body : acted_on_) {
    const BodyState state = world.state(ids_[body]);
    poses_[body] = {state.position, rotation_of(state.angle)};
    twists_[body] = {state.velocity, state.angular_velocity};
    wrenches_[body] = {};
  }
}

/// To the middle of the step, half of `dt` on, under the forces in `wrenches_`.
template <class Real>
void SceneForces<Real>::advance(const BasicWorld<Real>& world, double dt) {
  const double half = 0.5 * dt;
  for (const std::size_t body : acted_on_) {
    const BodyState state = world.state(ids_[body]);
    const double mass = world.mass(ids_[body]), inertia = world.inertia(ids_[body]);
    Twist<double>& twist = twists_[body];
    poses_[body] = {state.position + half * state.velocity,
                    rotation_of(state.angle + half * state.angular_velocity)};
    if (mass > 0) twist.velocity += half * (gravity_[body] + (1 / mass) * wrenches_[body].force);
    if (inertia > 0) twist.angular_velocity += half / inertia * wrenches_[body].torque;
    wrenches_[body] = {};
  }
}

template <class Real>
void SceneForces<Real>::apply(BasicWorld<Real>& world, double dt) {
  if (laws_.empty()) return;
  const double start = world.time(), end = start + dt;
  place(world);
  laws_.add(start, start + 0.5 * dt, poses_.data(), twists_.data(), wrenches_.data());
  advance(world, dt);
  laws_.add(start, end, poses_.data(), twists_.data(), wrenches_.data());
  for (const std::size_t body : acted_on_) {
    if (world.type(ids_[body]) != BodyType::Dynamic) continue;
    if (!is_sound(wrenches_[body])) {
      quarantine_pushed(world.data(), static_cast<int>(ids_[body].index), wrenches_[body]);
      continue;
    }
    world.apply_force(ids_[body], wrenches_[body].force);
    world.apply_torque(ids_[body], wrenches_[body].torque);
  }
}

template class SceneForces<float>;
template class SceneForces<double>;

}  // namespace plumb
