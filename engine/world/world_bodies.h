#pragma once

#include <algorithm>
#include <type_traits>

#include "engine/world/state/bodies.h"
#include "engine/world/state/contacts.h"
#include "engine/world/state/lock.h"
#include "engine/world/state/mass.h"
#include "engine/world/state/naming.h"
#include "engine/world/state/quarantine.h"
#include "engine/world/state/shape_boxes.h"
#include "engine/world/state/sleeping.h"
#include "engine/world/state/validate.h"
#include "engine/world/step/contact_reading.h"
#include "engine/world/world.h"

/// The members of BasicWorld about bodies; world.cpp instantiates them.
namespace plumb {

/// Writes `value(body)` for each body, by index, for as many as fit into `out`; returns the number of bodies.
template <class Real, class Value, class Function>
std::size_t fill_bodies(const WorldData<Real>& w, std::span<Value> out, const Function& value) {
  std::size_t count = 0;
  for (int body = 0; body < w.bodies.size() && count < out.size(); ++body) {
    if (w.bodies.used(body))
      out[count++] = value({static_cast<std::uint32_t>(body), w.bodies.generation(body)});
  }
  return static_cast<std::size_t>(w.bodies.count());
}

template <class Real>
BodyId BasicWorld<Real>::create_body(const BodyDefinition& definition,
                                     std::span<const ShapeDefinition> shapes) {
  unlocked(*this);
  validate(definition);
  const bool needs_mass_check =
      std::is_same_v<Real, float> && definition.type == BodyType::Dynamic && !definition.mass;
  for (const ShapeDefinition& shape : shapes) {
    const auto subject = [&] {
      const std::string which = "shape " + std::to_string(&shape - shapes.data());
      return definition.name.empty() ? which : which + " of " + body_subject(0, definition.name);
    };
    with_subject(subject, [&] {
      validate(shape);
      if (needs_mass_check) require_float_mass(shape);
    });
  }
  const int body = add_body(*data_, definition, shapes);
  return {static_cast<std::uint32_t>(body), data_->bodies.generation(body)};
}
template <class Real>
BodyId BasicWorld<Real>::create_body(const BodyDefinition& definition, const ShapeDefinition& shape) {
  unlocked(*this);
  return create_body(definition, std::span(&shape, 1));
}
template <class Real>
BodyId BasicWorld<Real>::create_body(const BodyDefinition& definition,
                                     std::span<const ShapeDefinition> shapes, std::vector<ShapeId>& made) {
  made.reserve(shapes.size());
  const BodyId body = create_body(definition, shapes);
  made.clear();
  for (int shape = data_->bodies[index_of(body)].first_shape; shape != kNone;
       shape = data_->shapes[shape].next)
    made.push_back({static_cast<std::uint32_t>(shape), data_->shapes.generation(shape)});
  std::reverse(made.begin(), made.end());
  return body;
}
template <class Real>
void BasicWorld<Real>::destroy(BodyId body) {
  unlocked(*this);
  remove_body(*data_, index_of(body));
}
template <class Real>
bool BasicWorld<Real>::valid(BodyId body) const {
  return data().bodies.holds(body.index, body.generation);
}
template <class Real>
std::vector<BodyId> BasicWorld<Real>::bodies() const {
  std::vector<BodyId> all(static_cast<std::size_t>(data().bodies.count()));
  bodies(all);
  return all;
}

template <class Real>
std::size_t BasicWorld<Real>::bodies(std::span<BodyId> out) const {
  return fill_bodies(data(), out, [](BodyId body) { return body; });
}
template <class Real>
std::size_t BasicWorld<Real>::poses(std::span<BodyPose> out) const {
  return fill_bodies(data(), out, [&](BodyId body) { return BodyPose{position(body), angle(body)}; });
}
template <class Real>
std::size_t BasicWorld<Real>::states(std::span<BodyState> out) const {
  return fill_bodies(data(), out, [&](BodyId body) { return state(body); });
}
template <class Real>
std::size_t BasicWorld<Real>::moved(std::span<BodyId> out) const {
  const WorldData<Real>& w = data();
  std::size_t count = 0;
  const auto add = [&](BodyId body) {
    if (count < out.size()) out[count] = body;
    ++count;
  };
  for (const int body : w.awake) add({static_cast<std::uint32_t>(body), w.bodies.generation(body)});
  // Bodies that have been woken again are in both lists.
  for (const BodyId body : w.events.fell_asleep) {
    if (valid(body) && !w.bodies[static_cast<int>(body.index)].awake) add(body);
  }
  return count;
}

template <class Real>
Vec2d BasicWorld<Real>::position(BodyId body) const {
  return origin_of(*data_, index_of(body));
}
template <class Real>
Vec2d BasicWorld<Real>::centre(BodyId body) const {
  const int index = index_of(body);
  const Vec2<Real> offset = data_->rotation[index] * centre_of_mass_shift(*data_, index);
  return data_->position[index] + offset.template as<double>();
}
template <class Real>
double BasicWorld<Real>::angle(BodyId body) const {
  return data_->bodies[index_of(body)].angle;
}
template <class Real>
Vec2d BasicWorld<Real>::velocity(BodyId body) const {
  const int index = index_of(body);
  const SolverBody<Real>& motion = data_->motion[index];
  if (!has_mass_change(*data_, index)) return motion.velocity.template as<double>();
  const Vec2<Real> offset = data_->rotation[index] * centre_of_mass_shift(*data_, index);
  return (motion.velocity + cross(motion.angular_velocity, offset)).template as<double>();
}
template <class Real>
double BasicWorld<Real>::angular_velocity(BodyId body) const {
  return static_cast<double>(data_->motion[index_of(body)].angular_velocity);
}
template <class Real>
Vec2d BasicWorld<Real>::velocity_at(BodyId body, Vec2d point) const {
  with_body_subject(*data_, index_of(body), [&] { require_query_position("body", "point", point); });
  return velocity(body) + cross(angular_velocity(body), point - centre(body));
}
template <class Real>
Vec2d BasicWorld<Real>::world_point(BodyId body, Vec2d local) const {
  const Rotation<Real> q = data_->rotation[index_of(body)];
  with_body_subject(*data_, index_of(body), [&] { require_query_position("body", "local", local); });
  return position(body) + Rotation<double>{q.c, q.s} * local;
}
template <class Real>
Vec2d BasicWorld<Real>::local_point(BodyId body, Vec2d world) const {
  const Rotation<Real> q = data_->rotation[index_of(body)];
  with_body_subject(*data_, index_of(body), [&] { require_query_position("body", "world", world); });
  return Rotation<double>{q.c, -q.s} * (world - position(body));
}
template <class Real>
BodyState BasicWorld<Real>::state(BodyId body) const {
  return {centre(body), angle(body), velocity(body), angular_velocity(body)};
}

template <class Real>
void BasicWorld<Real>::set_position(BodyId body, Vec2d position, double angle) {
  unlocked(*this);
  const int index = index_of(body);
  with_body_subject(*data_, index, [&] {
    require_finite("body", "position", position);
    require_finite("body", "angle", angle);
  });
  apply_mass_changes(*data_);
  teleport_body(*data_, index, position, angle);
}
template <class Real>
void BasicWorld<Real>::set_velocity(BodyId body, Vec2d velocity) {
  unlocked(*this);
  const int index = index_of(body);
  with_body_subject(*data_, index, [&] { require_finite("body", "velocity", velocity); });
  if (own_type(*data_, index) == BodyType::Static) return;
  apply_mass_changes(*data_);
  wake_moved(index);
  data_->motion[index].velocity = velocity.as<Real>();
}
template <class Real>
void BasicWorld<Real>::set_angular_velocity(BodyId body, double angular_velocity) {
  unlocked(*this);
  const int index = index_of(body);
  with_body_subject(*data_, index, [&] { require_finite("body", "angular_velocity", angular_velocity); });
  if (own_type(*data_, index) == BodyType::Static) return;
  apply_mass_changes(*data_);
  wake_moved(index);
  const bool locked = own_type(*data_, index) == BodyType::Dynamic && data_->bodies[index].lock_rotation;
  data_->motion[index].angular_velocity = locked ? Real(0) : static_cast<Real>(angular_velocity);
}
template <class Real>
void BasicWorld<Real>::move_towards(BodyId body, Vec2d position, double angle, double dt) {
  unlocked(*this);
  const int index = index_of(body);
  with_body_subject(*data_, index, [&] {
    require_finite("body", "position", position);
    require_finite("body", "angle", angle);
    require_positive("body", "dt", dt);
  });
  const Rotation<double> q = rotation_of(angle);
  const Vec2<Real> centre_in_body = data_->bodies[index].centre + centre_of_mass_shift(*data_, index);
  const Vec2d target = position + q * centre_in_body.template as<double>();
  const Vec2d velocity = (1 / dt) * (target - centre(body));
  const double angular_velocity = (angle - this->angle(body)) / dt;
  with_body_subject(*data_, index, [&] {
    require_finite("body", "velocity", velocity);
    require_finite("body", "angular_velocity", angular_velocity);
  });
  set_velocity(body, velocity);
  set_angular_velocity(body, angular_velocity);
}

template <class Real>
void BasicWorld<Real>::apply_force(BodyId body, Vec2d force) {
  unlocked(*this);
  apply_force(body, force, centre(body));
}
template <class Real>
void BasicWorld<Real>::apply_force(BodyId body, Vec2d force, Vec2d point) {
  unlocked(*this);
  const int index = index_of(body);
  with_body_subject(*data_, index, [&] {
    require_finite("body", "force", force);
    require_finite("body", "point", point);
  });
  if (!data_->is_dynamic(index)) return;
  apply_mass_changes(*data_);
  wake(index);
  Load<Real>& load = data_->loads.at(index, data_->bodies.size());
  load.force += force.as<Real>();
  load.torque += static_cast<Real>(cross(point - data_->position[index], force));
}
template <class Real>
void BasicWorld<Real>::apply_torque(BodyId body, double torque) {
  unlocked(*this);
  const int index = index_of(body);
  with_body_subject(*data_, index, [&] { require_finite("body", "torque", torque); });
  if (!data_->is_dynamic(index)) return;
  apply_mass_changes(*data_);
  wake(index);
  data_->loads.at(index, data_->bodies.size()).torque += static_cast<Real>(torque);
}
template <class Real>
void BasicWorld<Real>::apply_impulse(BodyId body, Vec2d impulse) {
  unlocked(*this);
  apply_impulse(body, impulse, centre(body));
}
template <class Real>
void BasicWorld<Real>::apply_impulse(BodyId body, Vec2d impulse, Vec2d point) {
  unlocked(*this);
  const int index = index_of(body);
  with_body_subject(*data_, index, [&] {
    require_finite("body", "impulse", impulse);
    require_finite("body", "point", point);
  });
  if (!data_->is_dynamic(index)) return;
  apply_mass_changes(*data_);
  wake(index);
  apply_body_impulse(*data_, index, impulse, cross(point - data_->position[index], impulse));
}
template <class Real>
void BasicWorld<Real>::apply_angular_impulse(BodyId body, double impulse) {
  unlocked(*this);
  const int index = index_of(body);
  with_body_subject(*data_, index, [&] { require_finite("body", "angular_impulse", impulse); });
  if (!data_->is_dynamic(index)) return;
  apply_mass_changes(*data_);
  wake(index);
  apply_body_impulse(*data_, index, {}, impulse);
}

template <class Real>
BodyType BasicWorld<Real>::type(BodyId body) const {
  return own_type(*data_, index_of(body));
}
template <class Real>
void BasicWorld<Real>::set_type(BodyId body, BodyType type) {
  unlocked(*this);
  const int index = index_of(body);
  with_body_subject(*data_, index, [&] { validate(type); });
  if (type == BodyType::Dynamic && !data_->bodies[index].mass_given)
    with_part_subject(*data_, "shape", index, [&] { require_float_masses(*data_, index); });
  apply_mass_changes(*data_);
  plumb::set_type(*data_, index, type);
}
template <class Real>
double BasicWorld<Real>::mass(BodyId body) const {
  const int index = index_of(body);
  if (own_type(*data_, index) != BodyType::Dynamic) return 0;
  return static_cast<double>(has_mass_change(*data_, index)
                                 ? static_cast<Real>(current_mass(*data_, index).mass)
                                 : data_->bodies[index].mass);
}
template <class Real>
double BasicWorld<Real>::inertia(BodyId body) const {
  const int index = index_of(body);
  if (own_type(*data_, index) != BodyType::Dynamic) return 0;
  return static_cast<double>(has_mass_change(*data_, index)
                                 ? static_cast<Real>(current_mass(*data_, index).inertia)
                                 : data_->bodies[index].inertia);
}
template <class Real>
void BasicWorld<Real>::set_mass(BodyId body, const MassProperties& mass) {
  unlocked(*this);
  const int index = index_of(body);
  with_body_subject(*data_, index, [&] { validate(BodyDefinition{.mass = mass}); });
  apply_mass_changes(*data_);
  plumb::set_mass(*data_, index, mass);
  wake(index);
}
template <class Real>
void BasicWorld<Real>::use_densities(BodyId body) {
  unlocked(*this);
  const int index = index_of(body);
  const bool needs_mass_check = own_type(*data_, index) == BodyType::Dynamic;
  if (needs_mass_check)
    with_part_subject(*data_, "shape", index, [&] { require_float_masses(*data_, index); });
  apply_mass_changes(*data_);
  data_->bodies[index].mass_given = false;
  update_mass(*data_, index);
  wake(index);
}
template <class Real>
void BasicWorld<Real>::set_gravity_scale(BodyId body, double scale) {
  unlocked(*this);
  const int index = index_of(body);
  with_body_subject(*data_, index, [&] { require_finite("body", "gravity_scale", scale); });
  plumb::set_gravity_scale(*data_, index, scale);
  wake(index);
}
template <class Real>
void BasicWorld<Real>::set_damping(BodyId body, double linear, double angular) {
  unlocked(*this);
  const int index = index_of(body);
  with_body_subject(*data_, index, [&] {
    require_not_negative("body", "linear_damping", linear);
    require_not_negative("body", "angular_damping", angular);
  });
  plumb::set_damping(*data_, index, linear, angular);
  wake(index);
}
template <class Real>
void BasicWorld<Real>::set_continuous(BodyId body, bool on) {
  unlocked(*this);
  plumb::set_continuous(*data_, index_of(body), on);
}
template <class Real>
bool BasicWorld<Real>::continuous(BodyId body) const {
  return data_->extras_of(index_of(body)).continuous;
}
template <class Real>
void BasicWorld<Real>::set_locks(BodyId body, bool x, bool y, bool rotation) {
  unlocked(*this);
  const int index = index_of(body);
  apply_mass_changes(*data_);
  BodyRecord<Real>& record = data_->bodies[index];
  record.lock_x = x, record.lock_y = y, record.lock_rotation = rotation;
  const bool dynamic = own_type(*data_, index) == BodyType::Dynamic;
  const bool turns = dynamic && !rotation && record.inertia > 0;
  data_->motion[index].inverse_mass = dynamic ? inverse_mass_of(record, record.mass) : Real(0);
  data_->motion[index].inverse_inertia = turns ? 1 / record.inertia : Real(0);
  if (rotation && dynamic) data_->motion[index].angular_velocity = 0;
  // Residues of rounding must not move locked axes either.
  data_->position_compensation.reset(index, data_->bodies.size());
  data_->topology_changed = true;
  invalidate_manifolds(*data_, index);
  wake(index);
}
template <class Real>
bool BasicWorld<Real>::awake(BodyId body) const {
  return data_->bodies[index_of(body)].awake;
}
template <class Real>
void BasicWorld<Real>::set_awake(BodyId body, bool awake) {
  unlocked(*this);
  const int index = index_of(body);
  if (awake) {
    wake(index);
  } else {
    put_to_sleep(*data_, index);
  }
}
template <class Real>
void BasicWorld<Real>::set_may_sleep(BodyId body, bool may_sleep) {
  unlocked(*this);
  const int index = index_of(body);
  data_->bodies[index].may_sleep = may_sleep;
  if (!may_sleep) wake(index);
}
template <class Real>
std::uint64_t BasicWorld<Real>::user_data(BodyId body) const {
  return data_->body_data.get(index_of(body));
}
template <class Real>
void BasicWorld<Real>::set_user_data(BodyId body, std::uint64_t data) {
  unlocked(*this);
  data_->body_data.at(index_of(body), data_->bodies.size()) = data;
}
template <class Real>
void BasicWorld<Real>::set_name(BodyId body, const std::string& name) {
  unlocked(*this);
  const int index = index_of(body);
  std::string copy = name;
  make_extras(*data_, index).name.swap(copy);
}
template <class Real>
void BasicWorld<Real>::set_enabled(BodyId body, bool enabled) {
  unlocked(*this);
  const int index = index_of(body);
  apply_mass_changes(*data_);
  if (enabled) {
    enable_body(*data_, index);
  } else {
    disable_body(*data_, index);
  }
}
template <class Real>
bool BasicWorld<Real>::enabled(BodyId body) const {
  return !data_->bodies[index_of(body)].quarantined;
}
template <class Real>
Aabb<double> BasicWorld<Real>::box(BodyId body) const {
  int shape = data_->bodies[index_of(body)].first_shape;
  if (shape == kNone) return {position(body), position(body)};
  Aabb<Real> all = current_aabb(*data_, shape);
  for (; shape != kNone; shape = data_->shapes[shape].next) all = merged(all, current_aabb(*data_, shape));
  return {all.lower.template as<double>(), all.upper.template as<double>()};
}
template <class Real>
bool BasicWorld<Real>::may_sleep(BodyId body) const {
  return data_->bodies[index_of(body)].may_sleep;
}
template <class Real>
double BasicWorld<Real>::gravity_scale(BodyId body) const {
  return static_cast<double>(data_->extras_of(index_of(body)).gravity_scale);
}
template <class Real>
double BasicWorld<Real>::linear_damping(BodyId body) const {
  return static_cast<double>(data_->extras_of(index_of(body)).linear_damping);
}
template <class Real>
double BasicWorld<Real>::angular_damping(BodyId body) const {
  return static_cast<double>(data_->extras_of(index_of(body)).angular_damping);
}
template <class Real>
BodyLocks BasicWorld<Real>::locks(BodyId body) const {
  return data_->bodies[index_of(body)].locks();
}
template <class Real>
const std::string& BasicWorld<Real>::name(BodyId body) const {
  return data_->extras_of(index_of(body)).name;
}

// Wakes a body and resets its sleep timer, because it must not fall asleep at once after a change from
// outside.
template <class Real>
void BasicWorld<Real>::wake(int body) {
  wake_body(*data_, body);
  data_->bodies[body].sleep_time = 0;
}
// Wakes a moved body, and the bodies that lie on it if it is kinematic.
template <class Real>
void BasicWorld<Real>::wake_moved(int body) {
  if (!data_->is_dynamic(body)) wake_neighbours(*data_, body);
  wake(body);
}

}  // namespace plumb
