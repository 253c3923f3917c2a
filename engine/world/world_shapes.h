#pragma once

#include <type_traits>

#include "engine/world/state/bodies.h"
#include "engine/world/state/lock.h"
#include "engine/world/state/naming.h"
#include "engine/world/state/shape_boxes.h"
#include "engine/world/state/shape_reading.h"
#include "engine/world/state/sleeping.h"
#include "engine/world/state/validate.h"
#include "engine/world/world.h"

/// The members of BasicWorld about shapes, chains and joints; world.cpp instantiates them.
namespace plumb {

/// Throws Error (Value) if the shape's density would give its body a mass that `Real` cannot hold.
template <class Real>
void require_mass_fits(const WorldData<Real>& w, int body, const ShapeDefinition& definition) {
  if constexpr (std::is_same_v<Real, float>) {
    if (own_type(w, body) == BodyType::Dynamic && !w.bodies[body].mass_given) require_float_mass(definition);
  }
}

template <class Real>
ShapeId BasicWorld<Real>::create_shape(BodyId body, const ShapeDefinition& definition) {
  unlocked(*this);
  const int index = index_of(body);
  with_part_subject(*data_, "shape", index, [&] {
    validate(definition);
    require_mass_fits(*data_, index, definition);
  });
  const int shape = add_shape(*data_, index, definition);
  return {static_cast<std::uint32_t>(shape), data_->shapes.generation(shape)};
}
template <class Real>
void BasicWorld<Real>::destroy(ShapeId shape) {
  unlocked(*this);
  const int index = index_of(shape);
  if (data_->shapes[index].chain != kNone) {
    throw Error(Error::Kind::Value, "shape", "handle", std::to_string(index),
                "is a segment of a chain; destroy the chain");
  }
  remove_shape(*data_, index);
}
template <class Real>
bool BasicWorld<Real>::valid(ShapeId shape) const {
  return data().shapes.holds(shape.index, shape.generation);
}
template <class Real>
BodyId BasicWorld<Real>::body(ShapeId shape) const {
  const int body = data_->shapes[index_of(shape)].body;
  return {static_cast<std::uint32_t>(body), data_->bodies.generation(body)};
}
template <class Real>
std::uint64_t BasicWorld<Real>::user_data(ShapeId shape) const {
  return data_->shape_data.get(index_of(shape));
}
template <class Real>
Material BasicWorld<Real>::material(ShapeId shape) const {
  return material_of(data_->shapes[index_of(shape)]);
}
template <class Real>
ShapeDefinition BasicWorld<Real>::definition(ShapeId shape) const {
  return shape_definition(*data_, index_of(shape));
}
template <class Real>
void BasicWorld<Real>::set_material(ShapeId shape, const Material& material) {
  unlocked(*this);
  const int index = index_of(shape);
  with_part_subject(*data_, "shape " + std::to_string(index), data_->shapes[index].body,
                    [&] { validate(ShapeDefinition{.material = material}); });
  const Lock<Real> lock(*data_, data_->has_rules());  // a rule may destroy the world
  plumb::set_material(*data_, index, material);
}
template <class Real>
void BasicWorld<Real>::set_geometry(ShapeId shape, const ShapeGeometry& geometry, Vec2d position,
                                    double angle) {
  unlocked(*this);
  const int index = index_of(shape), body = data_->shapes[index].body;
  if (data_->shapes[index].chain != kNone) {
    throw Error(Error::Kind::Value, "shape", "handle", std::to_string(index),
                "is a segment of a chain; create a chain with other points");
  }
  const ShapeDefinition definition{.geometry = geometry,
                                   .position = position,
                                   .angle = angle,
                                   .density = static_cast<double>(data_->shapes[index].density)};
  with_part_subject(*data_, "shape " + std::to_string(index), body, [&] {
    validate(definition);
    require_mass_fits(*data_, body, definition);
  });
  plumb::set_geometry(*data_, index, definition);
}
template <class Real>
Filter BasicWorld<Real>::filter(ShapeId shape) const {
  return data_->shapes[index_of(shape)].filter;
}
template <class Real>
double BasicWorld<Real>::density(ShapeId shape) const {
  return data_->shapes[index_of(shape)].density;
}
template <class Real>
bool BasicWorld<Real>::sensor(ShapeId shape) const {
  return data_->forms[index_of(shape)].sensor;
}
template <class Real>
bool BasicWorld<Real>::hit_events(ShapeId shape) const {
  return data_->shapes[index_of(shape)].hit_events;
}
template <class Real>
bool BasicWorld<Real>::pre_solve(ShapeId shape) const {
  return data_->shapes[index_of(shape)].pre_solve;
}
template <class Real>
void BasicWorld<Real>::set_filter(ShapeId shape, const Filter& filter) {
  unlocked(*this);
  plumb::set_filter(*data_, index_of(shape), filter);
}
template <class Real>
void BasicWorld<Real>::set_user_data(ShapeId shape, std::uint64_t data) {
  unlocked(*this);
  data_->shape_data.at(index_of(shape), data_->shapes.size()) = data;
}
template <class Real>
ChainId BasicWorld<Real>::chain(ShapeId shape) const {
  const int chain = data_->shapes[index_of(shape)].chain;
  return chain == kNone ? ChainId{}
                        : ChainId{static_cast<std::uint32_t>(chain), data_->chains.generation(chain)};
}
template <class Real>
Aabb<double> BasicWorld<Real>::box(ShapeId shape) const {
  const Aabb<Real> box = current_aabb(*data_, index_of(shape));
  return {box.lower.template as<double>(), box.upper.template as<double>()};
}
template <class Real>
void BasicWorld<Real>::set_density(ShapeId shape, double density) {
  unlocked(*this);
  const int index = index_of(shape);
  with_part_subject(*data_, "shape " + std::to_string(index), data_->shapes[index].body,
                    [&] { validate(ShapeDefinition{.density = density}); });
  plumb::set_density(*data_, index, density);
}
template <class Real>
void BasicWorld<Real>::set_sensor(ShapeId shape, bool sensor) {
  unlocked(*this);
  plumb::set_sensor(*data_, index_of(shape), sensor);
}
template <class Real>
void BasicWorld<Real>::set_hit_events(ShapeId shape, bool on) {
  unlocked(*this);
  const int index = index_of(shape);
  plumb::set_flags(*data_, index, on, data_->shapes[index].pre_solve);
}
template <class Real>
void BasicWorld<Real>::set_pre_solve(ShapeId shape, bool on) {
  unlocked(*this);
  const int index = index_of(shape);
  plumb::set_flags(*data_, index, data_->shapes[index].hit_events, on);
}
template <class Real>
std::vector<ShapeId> BasicWorld<Real>::overlapping(ShapeId sensor) const {
  const int index = index_of(sensor);
  for (const SensorRecord& record : data_->sensors) {
    if (record.shape == index) return record.visitors;
  }
  throw Error(Error::Kind::Value, "shape", "sensor", "false",
              "is not a sensor; make it one with `sensor = true`");
}

template <class Real>
ChainId BasicWorld<Real>::create_chain(BodyId body, const ChainDefinition& definition) {
  unlocked(*this);
  const int index = index_of(body);
  with_part_subject(*data_, "chain", index, [&] { validate(definition); });
  const int chain = add_chain(*data_, index, definition);
  return {static_cast<std::uint32_t>(chain), data_->chains.generation(chain)};
}
template <class Real>
void BasicWorld<Real>::destroy(ChainId chain) {
  unlocked(*this);
  remove_chain(*data_, index_of(chain));
}
template <class Real>
bool BasicWorld<Real>::valid(ChainId chain) const {
  return data().chains.holds(chain.index, chain.generation);
}
template <class Real>
std::vector<ShapeId> BasicWorld<Real>::segments(ChainId chain) const {
  std::vector<ShapeId> all;
  for (const int shape : data_->chains[index_of(chain)].shapes) {
    all.push_back({static_cast<std::uint32_t>(shape), data_->shapes.generation(shape)});
  }
  return all;
}

template <class Real>
ChainDefinition BasicWorld<Real>::definition(ChainId chain) const {
  return chain_definition(*data_, index_of(chain));
}

template <class Real>
JointId BasicWorld<Real>::create_joint(BodyId a, BodyId b, const JointDefinition& definition) {
  unlocked(*this);
  const int body_a = index_of(a), body_b = index_of(b);
  validate(definition);
  const int joint = add_joint(*data_, body_a, body_b, definition);
  return {static_cast<std::uint32_t>(joint), data_->joints.generation(joint)};
}
template <class Real>
void BasicWorld<Real>::destroy(JointId joint) {
  unlocked(*this);
  remove_joint(*data_, index_of(joint));
}
template <class Real>
bool BasicWorld<Real>::valid(JointId joint) const {
  return data().joints.holds(joint.index, joint.generation);
}
template <class Real>
const JointKind& BasicWorld<Real>::kind(JointId joint) const {
  return data_->joint_set.definition(data_->joints[index_of(joint)].slot);
}
template <class Real>
void BasicWorld<Real>::change(JointId joint, const JointKind& kind) {
  unlocked(*this);
  const JointRecord& record = data_->joints[index_of(joint)];
  data_->topology_changed = true;  // set before the joints' lists grow, which may fail halfway
  data_->joint_set.change(record.slot, kind);
  data_->joint_set.set_initial_angles(record.slot, data_->bodies[record.body_a].angle,
                                      data_->bodies[record.body_b].angle);
  wake(record.body_a), wake(record.body_b);
}
template <class Real>
JointReading BasicWorld<Real>::read(JointId joint) const {
  WorldData<Real>& w = *data_;
  const int slot = w.joints[index_of(joint)].slot;
  // The positions already include the motion of the last step.
  SolverBodies<Real> bodies = w.solver_bodies();
  const auto [a, b] = w.joint_set.bodies(slot);
  const SolverBody<Real> motion_a = w.motion[a], motion_b = w.motion[b];
  for (const int body : {a, b}) w.motion[body].delta_position = {}, w.motion[body].delta_angle = 0;
  const JointError<Real> error = w.joint_set.error(slot, bodies);
  JointReading reading;
  reading.force = static_cast<double>(w.joint_set.force(slot));
  reading.torque = static_cast<double>(w.joint_set.torque(slot));
  reading.linear_error = static_cast<double>(error.linear);
  reading.angular_error = static_cast<double>(error.angular);
  const auto is = [&]<class... Kinds>() {
    return (std::holds_alternative<Kinds>(w.joint_set.definition(slot)) || ...);
  };
  const bool has_length = is.template operator()<DistanceDefinition, PulleyDefinition>();
  const bool has_translation = is.template operator()<PrismaticDefinition, WheelDefinition>();
  const bool has_angle = !has_length && !is.template operator()<MouseDefinition, GearDefinition>();
  if (has_angle) reading.angle = static_cast<double>(w.joint_set.angle(slot, bodies));
  if (has_translation) reading.translation = static_cast<double>(w.joint_set.translation(slot, bodies));
  if (has_length) reading.length = static_cast<double>(w.joint_set.length(slot, bodies));
  w.motion[a] = motion_a, w.motion[b] = motion_b;
  return reading;
}
template <class Real>
JointStiffness BasicWorld<Real>::stiffness(JointId joint) const {
  return stiffness_of(*data_, index_of(joint));
}
template <class Real>
std::pair<BodyId, BodyId> BasicWorld<Real>::bodies(JointId joint) const {
  const JointRecord& record = data_->joints[index_of(joint)];
  const auto id = [&](int body) {
    return BodyId{static_cast<std::uint32_t>(body), data_->bodies.generation(body)};
  };
  return {id(record.body_a), id(record.body_b)};
}
template <class Real>
JointDefinition BasicWorld<Real>::definition(JointId joint) const {
  const JointRecord& record = data_->joints[index_of(joint)];
  return {data_->joint_set.definition(record.slot),
          record.collide,
          record.break_force,
          record.break_torque,
          record.user_data,
          record.report_force,
          record.report_torque};
}
template <class Real>
void BasicWorld<Real>::set_load_events(JointId joint, double force, double torque) {
  unlocked(*this);
  const int index = index_of(joint);
  require_not_negative("joint", "report_force", force);
  require_not_negative("joint", "report_torque", torque);
  plumb::set_load_events(*data_, index, force, torque);
}
template <class Real>
std::uint64_t BasicWorld<Real>::user_data(JointId joint) const {
  return data_->joints[index_of(joint)].user_data;
}
template <class Real>
void BasicWorld<Real>::set_user_data(JointId joint, std::uint64_t data) {
  unlocked(*this);
  data_->joints[index_of(joint)].user_data = data;
}
template <class Real>
BodyId BasicWorld<Real>::body(ChainId chain) const {
  const int body = data_->chains[index_of(chain)].body;
  return {static_cast<std::uint32_t>(body), data_->bodies.generation(body)};
}

}  // namespace plumb
