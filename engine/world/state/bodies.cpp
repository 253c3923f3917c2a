#include "engine/world/state/bodies.h"

#include <algorithm>
#include <utility>

#include "engine/core/capacity.h"
#include "engine/math/trigonometry.h"
#include "engine/world/state/contacts.h"
#include "engine/world/state/mass.h"
#include "engine/world/state/new_shape.h"
#include "engine/world/state/quarantine.h"
#include "engine/world/state/sleeping.h"

namespace plumb {
namespace {

// Reserves memory for a new body, and for all bodies to be awake.
template <class Real>
void reserve_body(WorldData<Real>& w, bool has_data) {
  w.bodies.reserve_more(1);
  const int size = w.bodies.size() + 1;
  const std::size_t capacity = static_cast<std::size_t>(size);
  ensure_capacity(w.motion, capacity), ensure_capacity(w.rotation, capacity),
      ensure_capacity(w.position, capacity);
  ensure_capacity(w.extents, capacity), ensure_capacity(w.enlarged, capacity),
      ensure_capacity(w.awake, capacity);
  w.loads.reserve(size, false), w.body_data.reserve(size, has_data),
      w.position_compensation.reserve(size, false), w.rest_displacements.reserve(size, w.settings.sleeping);
}

template <class T>
void reserve_one(std::vector<T>& list) {
  ensure_capacity(list, list.size() + 1);
}

template <class Real>
void reset_body_data(WorldData<Real>& w, int body) {
  const int size = w.bodies.size();
  resize_with_growth(w.motion, size), resize_with_growth(w.rotation, size),
      resize_with_growth(w.position, size);
  resize_with_growth(w.extents, size), resize_with_growth(w.enlarged, size);
  w.loads.reset(body, size), w.body_data.reset(body, size), w.position_compensation.reset(body, size);
  w.rest_displacements.reset(body, size);
  w.motion[body] = {}, w.rotation[body] = {}, w.extents[body] = 0, w.enlarged[body] = 0;
}

template <class Real>
bool has_extras(const BodyExtras<Real>& own) {
  return !own.name.empty() || own.gravity_scale != 1 || own.linear_damping != 0 || own.angular_damping != 0 ||
         own.mass_centre != Vec2<Real>{} || !own.continuous;
}

// Reserves memory for a body's shapes in a tree and in the move buffer.
template <class Real>
void reserve_proxies(WorldData<Real>& w, int body, BodyType type) {
  std::size_t shapes = 0;
  for (int shape = w.bodies[body].first_shape; shape != kNone; shape = w.shapes[shape].next) ++shapes;
  w.tree_of(type).reserve_more(shapes);
  ensure_capacity(w.move_buffer, w.move_buffer.size() + shapes);
  ensure_capacity(w.awake, w.awake.size() + 1);
}

// Tells all joints of a body whether it is dynamic. Those without a dynamic body take no part in steps. All
// bodies of the joints must be awake. If that throws, no joint is changed.
template <class Real>
void set_joints_dynamic(WorldData<Real>& w, int body, bool is_dynamic) {
  const auto set = [&](const JointRecord& joint, bool to) {
    const bool dynamic_a = joint.body_a == body ? to : w.is_dynamic(joint.body_a),
               dynamic_b = joint.body_b == body ? to : w.is_dynamic(joint.body_b),
               active = !has_quarantined_body(w, joint) && (dynamic_a || dynamic_b);
    w.joint_set.set_dynamic(joint.slot, dynamic_a, dynamic_b, active);
  };
  const int first = w.bodies[body].first_joint;
  try {
    for_each_edge(w.joints, first, [&](int, const JointRecord& joint) { set(joint, is_dynamic); });
  } catch (...) {
    for_each_edge(w.joints, first, [&](int, const JointRecord& joint) { set(joint, w.is_dynamic(body)); });
    throw;
  }
  for_each_edge(w.joints, first,
                [&](int, JointRecord& joint) { joint.active = w.joint_set.active(joint.slot); });
}

template <class Real>
void wake_touched_by(WorldData<Real>& w, int body) {
  for (int shape = w.bodies[body].first_shape; shape != kNone; shape = w.shapes[shape].next)
    wake_touched(w, shape);
}

template <class Real>
Rotation<Real> rounded(Rotation<double> q) {
  return {static_cast<Real>(q.c), static_cast<Real>(q.s)};
}

}  // namespace

template <class Real>
int add_body(WorldData<Real>& w, const BodyDefinition& definition, std::span<const ShapeDefinition> shapes) {
  // First do everything that may be rejected or may run out of memory.
  std::vector<NewShape<Real>> made;
  made.reserve(shapes.size());
  for (const ShapeDefinition& shape : shapes) made.push_back(prepare_shape<Real>(shape));
  BodyRecord<Real> record;
  record.type = definition.type;
  record.may_sleep = definition.may_sleep;
  record.lock_x = definition.lock_x, record.lock_y = definition.lock_y;
  record.lock_rotation = definition.lock_rotation;
  record.angle = definition.angle;
  BodyExtras<Real> own{definition.name, static_cast<Real>(definition.gravity_scale),
                       static_cast<Real>(definition.linear_damping),
                       static_cast<Real>(definition.angular_damping)};
  if (definition.mass) own.mass_centre = definition.mass->centre.as<Real>();
  own.continuous = definition.continuous;
  reserve_body(w, definition.user_data != 0);
  reserve_shapes<Real>(w, definition.type, made);
  reserve_recentring<Real>(w, made);
  if (has_extras(own)) w.body_extras.reserve_more(1);
  if (!definition.awake) reserve_one(w.event_buffer().fell_asleep);

  const int body = w.bodies.add(record);
  reset_body_data(w, body);
  if (definition.user_data != 0) w.body_data.at(body, w.bodies.size()) = definition.user_data;
  if (has_extras(own)) w.bodies[body].uncommon = w.body_extras.add(std::move(own));
  w.position[body] = definition.position;
  w.rotation[body] = rounded<Real>(rotation_of(definition.angle));
  if (definition.type != BodyType::Static) add_awake(w, body);
  for (const NewShape<Real>& shape : made) insert_shape(w, body, shape);
  if (definition.mass) {
    set_mass(w, body, *definition.mass);
  } else {
    update_mass(w, body);
  }
  if (definition.type != BodyType::Static) {
    w.motion[body].velocity = definition.velocity.as<Real>();
    const bool locked = definition.type == BodyType::Dynamic && definition.lock_rotation;
    w.motion[body].angular_velocity = locked ? Real(0) : static_cast<Real>(definition.angular_velocity);
  }
  for (int shape = w.bodies[body].first_shape; shape != kNone; shape = w.shapes[shape].next)
    create_proxy(w, shape);
  if (!definition.awake && definition.type != BodyType::Static) fall_asleep(w, body);
  if (definition.type == BodyType::Static) wake_touched_by(w, body);
  return body;
}

template <class Real>
void remove_body(WorldData<Real>& w, int body) {
  wake_neighbours(w, body);
  destroy_contacts_of(w, body);
  if (w.bodies[body].quarantined)
    std::erase_if(w.quarantine, [&](const QuarantinedBody& each) { return each.body == body; });
  while (w.bodies[body].first_joint != kNone) remove_joint(w, w.bodies[body].first_joint / 2);
  while (w.bodies[body].first_shape != kNone) {
    const int shape = w.bodies[body].first_shape;
    if (w.shapes[shape].chain != kNone) {
      erase_chain(w, w.shapes[shape].chain);
    } else {
      erase_shape(w, shape);
    }
  }
  if (w.bodies[body].awake) remove_awake(w, body);
  if (w.bodies[body].uncommon != kNone) w.body_extras.remove(w.bodies[body].uncommon);
  if (has_mass_change(w, body)) std::erase(w.mass_changed_bodies, body);
  w.motion[body] = {};
  w.bodies.remove(body);
}

template <class Real>
Vec2d origin_of(const WorldData<Real>& w, int body) {
  return w.position[body] - (w.rotation[body] * w.bodies[body].centre).template as<double>();
}

template <class Real>
BodyExtras<Real>& make_extras(WorldData<Real>& w, int body) {
  int& place = w.bodies[body].uncommon;
  if (place == kNone) place = w.body_extras.add({});
  return w.body_extras[place];
}

template <class Real>
void set_gravity_scale(WorldData<Real>& w, int body, double scale) {
  const Real target = static_cast<Real>(scale);
  if (w.extras_of(body).gravity_scale != target) make_extras(w, body).gravity_scale = target;
}

template <class Real>
void set_damping(WorldData<Real>& w, int body, double linear, double angular) {
  const Real target = static_cast<Real>(linear), target_angular = static_cast<Real>(angular);
  const BodyExtras<Real>& now = w.extras_of(body);
  if (now.linear_damping == target && now.angular_damping == target_angular) return;
  BodyExtras<Real>& own = make_extras(w, body);
  own.linear_damping = target, own.angular_damping = target_angular;
}

template <class Real>
void set_continuous(WorldData<Real>& w, int body, bool on) {
  if (w.extras_of(body).continuous != on) make_extras(w, body).continuous = on;
}

template <class Real>
void teleport_body(WorldData<Real>& w, int body, Vec2d origin, double angle) {
  reserve_proxies(w, body, w.bodies[body].type);
  wake_neighbours(w, body);
  BodyRecord<Real>& record = w.bodies[body];
  const Vec2d before = w.position[body];
  w.rotation[body] = rounded<Real>(rotation_of(angle));
  w.position[body] = origin + (w.rotation[body] * record.centre).template as<double>();
  if (w.position[body] != before || record.angle != angle) record.sleep_time = 0;
  record.angle = angle;
  w.motion[body].delta_position = {}, w.motion[body].delta_angle = 0;
  w.position_compensation.reset(body, w.bodies.size());
  invalidate_manifolds(w, body);
  for_each_edge(w.joints, record.first_joint,
                [&](int, JointRecord& joint) { w.joint_set.reset_impulses(joint.slot); });
  for (int shape = record.first_shape; shape != kNone; shape = w.shapes[shape].next) {
    destroy_proxy(w, shape);
    create_proxy(w, shape);
  }
  w.enlarged[body] = 1;
  wake_touched_by(w, body);
}

template <class Real>
void set_type(WorldData<Real>& w, int body, BodyType type) {
  BodyRecord<Real>& record = w.bodies[body];
  if (record.quarantined) {
    if (own_type(w, body) == type) return;
    quarantine_of(w, body).type = type;
    update_mass_for_type(w, body);
    return;
  }
  if (record.type == type) return;
  reserve_proxies(w, body, type);
  wake_neighbours(w, body);
  destroy_contacts_of(w, body);
  set_joints_dynamic(w, body, type == BodyType::Dynamic);
  for (int shape = record.first_shape; shape != kNone; shape = w.shapes[shape].next) destroy_proxy(w, shape);
  if (record.awake) remove_awake(w, body);
  record.type = type;
  w.position_compensation.reset(body, w.bodies.size());
  if (type != BodyType::Static) add_awake(w, body);
  if (type == BodyType::Static) w.motion[body] = {};
  update_mass_for_type(w, body);
  for (int shape = record.first_shape; shape != kNone; shape = w.shapes[shape].next) create_proxy(w, shape);
  wake_touched_by(w, body);
}

#define PLUMB_FOR(Real)                                                                             \
  template int add_body(WorldData<Real>&, const BodyDefinition&, std::span<const ShapeDefinition>); \
  template void remove_body(WorldData<Real>&, int);                                                 \
  template BodyExtras<Real>& make_extras(WorldData<Real>&, int);                                    \
  template Vec2d origin_of(const WorldData<Real>&, int);                                            \
  template void set_gravity_scale(WorldData<Real>&, int, double);                                   \
  template void set_damping(WorldData<Real>&, int, double, double);                                 \
  template void set_continuous(WorldData<Real>&, int, bool);                                        \
  template void teleport_body(WorldData<Real>&, int, Vec2d, double);                                \
  template void set_type(WorldData<Real>&, int, BodyType);
PLUMB_FOR(float)
PLUMB_FOR(double)
#undef PLUMB_FOR

}  // namespace plumb
