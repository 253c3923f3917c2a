#include "engine/world/scene/scene_forces.h"

#include <cmath>
#include <variant>

#include "engine/forces/compile.h"
#include "engine/math/small_rotation.h"
#include "engine/math/trigonometry.h"
#include "engine/world/forces/law_bodies.h"
#include "engine/world/state/lock.h"
#include "engine/world/state/validate.h"

namespace plumb {
namespace {

bool is_no_spring_or_drag(const ForceLaw& law) {
  return !std::holds_alternative<SpringForce>(law) && !std::holds_alternative<LinearDrag>(law) &&
         !std::holds_alternative<QuadraticDrag>(law);
}

// Returns the speed s at the middle of a step by the implicit midpoint method. It satisfies
// a s^2 + b s = |u|, where u is the velocity without drag. The formula avoids a difference of nearly equal
// numbers.
double midpoint_speed(Vec2d u, double half_step, double linear, double quadratic, double mass) {
  const double a = half_step * quadratic / mass, b = 1 + half_step * linear / mass,
               speed = std::sqrt(length_squared(u));
  return 2 * speed / (b + std::sqrt(b * b + 4 * a * speed));
}

// Returns the velocity at which drag is evaluated; drag changes the velocity by -z times this value. `start`
// is the velocity at the start of the step, `gain` its change in half a step by other forces. Without these,
// a velocity decays by 1 / (1 + z + z^2 / 2), which is exp(-z) to second order and near 0 for large z; the
// implicit midpoint method would reverse it.
template <class Value>
Value drag_velocity(Value start, Value gain, double z) {
  return (1 / (1 + z + 0.5 * z * z)) * ((1 + 0.5 * z) * start + (1 + z) * gain);
}

}  // namespace

template <class Real>
SceneForces<Real>::SceneForces(const Scene& scene, const SceneParts& parts)
    : laws_(scene, is_no_spring_or_drag) {
  if (scene.forces.empty()) return;
  const std::size_t bodies = scene.bodies.size();
  drags_.resize(bodies), spring_bodies_.resize(bodies);
  poses_.resize(bodies), twists_.resize(bodies), wrenches_.resize(bodies);
  ids_ = parts.bodies;
  const LawCompiler compiler(scene);
  std::vector<char> has_force(scene.bodies.size(), 0);
  for (const ForceLaw& law : scene.forces) {
    if (const auto* linear = std::get_if<LinearDrag>(&law)) {
      const std::size_t body = compiler.compile(*linear).body;
      drags_[body].linear += linear->coefficient, drags_[body].angular += linear->angular_coefficient;
      has_force[body] = 1;
    }
    if (const auto* quadratic = std::get_if<QuadraticDrag>(&law)) {
      const std::size_t body = compiler.compile(*quadratic).body;
      drags_[body].quadratic += quadratic->coefficient;
      has_force[body] = 1;
    }
    const auto* spring = std::get_if<SpringForce>(&law);
    uses_midpoint_ = uses_midpoint_ || spring == nullptr;
    if (spring == nullptr) continue;
    springs_.push_back(compiler.compile(*spring));
    for (const int end : {springs_.back().a, springs_.back().b})
      if (end != kFixedFrame) has_force[static_cast<std::size_t>(end)] = 1;
  }
  for (std::size_t body = 0; body < scene.bodies.size(); ++body) {
    const bool dynamic = scene.bodies[body].type == BodyType::Dynamic;
    gravity_.push_back(dynamic ? scene.bodies[body].gravity_scale * scene.gravity : Vec2d{});
    if (laws_.acts_on(body) || has_force[body] != 0) acted_on_.push_back(body);
  }
}

template <class Real>
void SceneForces<Real>::read_states(const BasicWorld<Real>& world) {
  for (const std::size_t body : acted_on_) {
    const BodyState state = world.state(ids_[body]);
    poses_[body] = {state.position, rotation_of(state.angle)};
    twists_[body] = {state.velocity, state.angular_velocity};
    wrenches_[body] = {};
  }
}

/// Advances velocities to the middle of the step under the forces in `wrenches_` and drag, and positions by
/// the fraction `evaluation_fraction` of the step.
template <class Real>
void SceneForces<Real>::advance_to_midpoint(const BasicWorld<Real>& world, double dt) {
  const double half_step = 0.5 * dt;
  for (const std::size_t body : acted_on_) {
    const BodyState state = world.state(ids_[body]);
    const double mass = world.mass(ids_[body]), inertia = world.inertia(ids_[body]);
    Twist<double>& twist = twists_[body];
    const double ahead = evaluation_fraction(world.data(), static_cast<int>(ids_[body].index), dt) * dt;
    poses_[body] = {state.position + ahead * state.velocity,
                    rotation_of(state.angle + ahead * state.angular_velocity)};
    Drag& drag = drags_[body];
    if (mass > 0) {
      const Vec2d gain = half_step * (gravity_[body] + (1 / mass) * wrenches_[body].force);
      const double speed =
          midpoint_speed(twist.velocity + gain, half_step, drag.linear, drag.quadratic, mass);
      drag.current = drag.linear + drag.quadratic * speed;
      twist.velocity = drag_velocity(twist.velocity, gain, dt * drag.current / mass);
    }
    if (inertia > 0) {
      const double gain = half_step / inertia * wrenches_[body].torque;
      twist.angular_velocity = drag_velocity(twist.angular_velocity, gain, dt * drag.angular / inertia);
    }
    wrenches_[body] = {};
  }
}

/// Collects the springs' bodies and ends at the start of the step. If the world moves a body by dt v + c dt^2
/// a, the springs use x + (1/2 - c) dt v as its position. The displacement between this and the corresponding
/// position in the next step is dt times the mean of the velocities.
template <class Real>
void SceneForces<Real>::prepare_springs(const BasicWorld<Real>& world, double dt) {
  elastic_.clear();
  const int frame = elastic_.add_body({});
  const WorldData<Real>& w = world.data();
  for (const std::size_t body : acted_on_) {
    const int index = static_cast<int>(ids_[body].index);
    const BodyRecord<Real>& record = w.bodies[index];
    const double inverse_mass = static_cast<double>(w.motion[index].inverse_mass);
    const double ahead = (evaluation_fraction(w, index, dt) - 0.5) * dt;
    SpringBody& spring_body = spring_bodies_[body];
    spring_body.body = elastic_.add_body(
        {.position = poses_[body].position + ahead * twists_[body].velocity,
         .inverse_mass = {record.lock_x ? 0 : inverse_mass, record.lock_y ? 0 : inverse_mass},
         .inverse_inertia = static_cast<double>(w.motion[index].inverse_inertia)});
    spring_body.rotation = rotated_by(poses_[body].rotation, ahead * twists_[body].angular_velocity);
    spring_body.start = twists_[body];
  }
  const auto anchor_of = [&](int body, Vec2d anchor) {
    return body == kFixedFrame ? std::pair(frame, anchor)
                               : std::pair(spring_bodies_[body].body, spring_bodies_[body].rotation * anchor);
  };
  for (const SpringForceLaw& law : springs_) {
    const auto [a, arm_a] = anchor_of(law.a, law.anchor_a);
    const auto [b, arm_b] = anchor_of(law.b, law.anchor_b);
    elastic_.add({a, b, arm_a, arm_b, law.rest_length, law.stiffness, law.damping});
  }
}

/// Adds the forces of the springs over the step, given all other forces in `wrenches_`.
template <class Real>
void SceneForces<Real>::add_springs(double dt) {
  if (springs_.empty()) return;
  for (const std::size_t body : acted_on_) {
    const SpringBody& spring_body = spring_bodies_[body];
    const ElasticStep::Body& b = elastic_.body(spring_body.body);
    const Vec2d force = wrenches_[body].force;
    const Vec2d gain{b.inverse_mass.x > 0 ? gravity_[body].x + b.inverse_mass.x * force.x : 0,
                     b.inverse_mass.y > 0 ? gravity_[body].y + b.inverse_mass.y * force.y : 0};
    elastic_.set_free_motion(
        spring_body.body, dt * (spring_body.start.velocity + 0.5 * dt * gain),
        dt * (spring_body.start.angular_velocity + 0.5 * dt * b.inverse_inertia * wrenches_[body].torque));
  }
  elastic_.solve(dt);
  for (const std::size_t body : acted_on_) wrenches_[body] += elastic_.wrench(spring_bodies_[body].body);
}

/// Adds the forces of the springs at the poses in `poses_`.
template <class Real>
void SceneForces<Real>::add_springs_at_start() {
  const Pose<double> fixed_pose{};
  const Twist<double> no_motion{};
  for (const SpringForceLaw& law : springs_) {
    const bool has_a = law.a != kFixedFrame, has_b = law.b != kFixedFrame;
    const auto [on_a, on_b] =
        law.wrenches(has_a ? poses_[law.a] : fixed_pose, has_a ? twists_[law.a] : no_motion,
                     has_b ? poses_[law.b] : fixed_pose, has_b ? twists_[law.b] : no_motion);
    if (has_a) wrenches_[law.a] += on_a;
    if (has_b) wrenches_[law.b] += on_b;
  }
}

/// Adds drag at the velocities in `twists_`.
template <class Real>
void SceneForces<Real>::add_drag() {
  for (const std::size_t body : acted_on_) {
    const Drag& drag = drags_[body];
    wrenches_[body].force -= drag.current * twists_[body].velocity;
    wrenches_[body].torque -= drag.angular * twists_[body].angular_velocity;
  }
}

template <class Real>
void SceneForces<Real>::apply(BasicWorld<Real>& world, double dt) {
  require_positive("scene forces", "dt", dt);
  if (empty()) return;
  const double start = world.time(), end = start + dt;
  read_states(world);
  if (!springs_.empty()) prepare_springs(world, dt);
  if (uses_midpoint_) {
    laws_.add(start, start + 0.5 * dt, poses_.data(), twists_.data(), wrenches_.data());
    add_springs(dt);
    advance_to_midpoint(world, dt);
    laws_.add(start, end, poses_.data(), twists_.data(), wrenches_.data());
    add_drag();
  }
  add_springs(dt);
  apply_wrenches(world);
}

template <class Real>
void SceneForces<Real>::apply_at_start(BasicWorld<Real>& world, double dt) {
  require_positive("scene forces", "dt", dt);
  if (empty()) return;
  read_states(world);
  laws_.add(world.time(), world.time() + dt, poses_.data(), twists_.data(), wrenches_.data());
  add_springs_at_start();
  for (const std::size_t body : acted_on_) {
    Drag& drag = drags_[body];
    drag.current = drag.linear + drag.quadratic * std::sqrt(length_squared(twists_[body].velocity));
  }
  add_drag();
  apply_wrenches(world);
}

/// Passes the wrenches to the world; a force that is not finite quarantines its body.
template <class Real>
void SceneForces<Real>::apply_wrenches(BasicWorld<Real>& world) {
  for (const std::size_t body : acted_on_) {
    if (world.type(ids_[body]) != BodyType::Dynamic) continue;
    if (!is_sound(wrenches_[body])) {
      quarantine_pushed(unlocked_with_masses(world), static_cast<int>(ids_[body].index), wrenches_[body]);
      continue;
    }
    world.apply_force(ids_[body], wrenches_[body].force);
    world.apply_torque(ids_[body], wrenches_[body].torque);
  }
}

template class SceneForces<float>;
template class SceneForces<double>;

}  // namespace plumb
