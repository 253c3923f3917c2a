#include "engine/world/bodies.h"

#include <algorithm>
#include <limits>
#include <type_traits>

#include "engine/geometry/convex_bounds.h"
#include "engine/geometry/convex_core.h"
#include "engine/geometry/convex_mass.h"
#include "engine/math/trigonometry.h"
#include "engine/world/contacts.h"
#include "engine/world/islands.h"
#include "engine/world/quarantine.h"
#include "engine/world/step.h"
#include "engine/world/validate.h"

namespace plumb {
namespace {

template <class Real>
void clear_place(WorldData<Real>& w, int body) {
  const int size = w.bodies.size();
  make_room(w.motion, size), make_room(w.rotation, size), make_room(w.position, size);
  make_room(w.extents, size), make_room(w.enlarged, size);
  w.loads.renew(body, size), w.body_data.renew(body, size), w.remainders.renew(body, size);
  w.motion[body] = {}, w.rotation[body] = {}, w.extents[body] = 0, w.enlarged[body] = 0;
}

template <class Real>
UncommonBody<Real>& make_uncommon(WorldData<Real>& w, int body) {
  int& place = w.bodies[body].uncommon;
  if (place == kNone) place = w.uncommon.add({});
  return w.uncommon[place];
}

template <class Real>
Rotation<Real> rounded(Rotation<double> q) {
  return {static_cast<Real>(q.c), static_cast<Real>(q.s)};
}

// Moves the frame that corners and anchors stand in: the centre of mass.
template <class Real>
void recentre(WorldData<Real>& w, int body, Vec2<Real> centre) {
  BodyRecord<Real>& record = w.bodies[body];
  const Vec2<Real> shift = centre - record.centre;
  if (shift == Vec2<Real>{}) return;
  for (int shape = record.first_shape; shape != kNone; shape = w.shapes[shape].next) {
    ShapeForm<Real>& form = w.forms[shape];
    Corner<Real> moved[kMaxCorners + 2];
    const auto corners = w.corners.run(form.corner, form.stored());
    std::copy(corners.begin(), corners.end(), moved);
    for (int i = 0; i < form.stored(); ++i) moved[i].point -= shift;
    w.corners.remove(form.corner, form.stored());
    form.corner = w.corners.add({moved, corners.size()});
  }
  const Vec2<Real> arm = w.rotation[body] * shift;
  w.motion[body].velocity += cross(w.motion[body].angular_velocity, arm);  // of the new centre
  w.position[body] += arm.template as<double>();
  record.centre = centre;
  for_each_edge(w.joints, record.first_joint, [&](int, JointRecord& joint) {
    w.joint_set.recentre(joint.slot, w.bodies[joint.body_a].centre, w.bodies[joint.body_b].centre);
  });
}

template <class Real>
void update_extents(WorldData<Real>& w, int body) {
  BodyRecord<Real>& record = w.bodies[body];
  Real extent = 0, half_width = record.first_shape == kNone ? Real(0) : std::numeric_limits<Real>::max();
  for (int shape = record.first_shape; shape != kNone; shape = w.shapes[shape].next) {
    extent = std::max(extent, convex_extent(w.convex(shape), Vec2<Real>{}));
    half_width = std::min(half_width, convex_passing_width(w.convex(shape)));
  }
  w.extents[body] = extent;
  record.half_width = half_width;
}

template <class Real>
void apply_mass(WorldData<Real>& w, int body, const MassProperties& mass) {
  BodyRecord<Real>& record = w.bodies[body];
  BodyMotion<Real>& motion = w.motion[body];
  recentre(w, body, mass.centre.as<Real>());
  w.ties_changed = true;
  // Shapes may weigh more than a number holds, or so little that its reciprocal is none.
  const auto held = [](double x) {
    return static_cast<Real>(std::min<double>(x, std::numeric_limits<Real>::max()));
  };
  record.mass = held(mass.mass), record.inertia = held(mass.inertia);
  const bool dynamic = own_type(w, body) == BodyType::Dynamic;
  motion.inverse_mass = dynamic ? held(1 / mass.mass) : Real(0);
  motion.inverse_inertia =
      dynamic && !record.lock_rotation && mass.inertia > 0 ? held(1 / mass.inertia) : Real(0);
  update_extents(w, body);
  forget_manifolds(w, body);
}

template <class Real>
ConvexMass mass_of(const WorldData<Real>& w, int shape) {
  const Convex<Real> convex = w.convex(shape);
  Corner<double> corners[kMaxCorners];
  for (int i = 0; i < convex.count; ++i) {
    corners[i] = {convex.corners[i].point.template as<double>(),
                  convex.corners[i].normal.template as<double>()};
  }
  return convex_mass({corners, convex.count, static_cast<double>(convex.radius)},
                     static_cast<double>(w.shapes[shape].density));
}

}  // namespace

template <class Real>
int add_body(WorldData<Real>& w, const BodyDefinition& definition, std::span<const ShapeDefinition> shapes) {
  BodyRecord<Real> record;
  record.type = definition.type;
  record.may_sleep = definition.may_sleep;
  record.lock_x = definition.lock_x, record.lock_y = definition.lock_y;
  record.lock_rotation = definition.lock_rotation;
  record.angle = definition.angle;
  const int body = w.bodies.add(record);
  clear_place(w, body);
  if (definition.user_data != 0) w.body_data.at(body, w.bodies.size()) = definition.user_data;
  set_gravity_scale(w, body, definition.gravity_scale);
  set_damping(w, body, definition.linear_damping, definition.angular_damping);
  if (!definition.name.empty()) make_uncommon(w, body).name = definition.name;
  w.position[body] = definition.position;
  w.rotation[body] = rounded<Real>(rotation_of(definition.angle));
  if (definition.type != BodyType::Static) enter_awake(w, body);
  for (const ShapeDefinition& shape : shapes) insert_shape(w, body, shape);
  if (definition.mass) {
    set_mass(w, body, *definition.mass);
  } else {
    update_mass(w, body);
  }
  if (definition.type != BodyType::Static) {
    w.motion[body].velocity = definition.velocity.as<Real>();
    w.motion[body].angular_velocity = static_cast<Real>(definition.angular_velocity);
  }
  for (int shape = w.bodies[body].first_shape; shape != kNone; shape = w.shapes[shape].next)
    enter_tree(w, shape);
  if (!definition.awake) put_to_sleep(w, body);
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
      remove_chain(w, w.shapes[shape].chain);
    } else {
      take_out_shape(w, shape);
    }
  }
  if (w.bodies[body].awake) leave_awake(w, body);
  if (w.bodies[body].uncommon != kNone) w.uncommon.remove(w.bodies[body].uncommon);
  w.motion[body] = {};
  w.bodies.remove(body);
}

template <class Real>
Vec2d origin_of(const WorldData<Real>& w, int body) {
  return w.position[body] - (w.rotation[body] * w.bodies[body].centre).template as<double>();
}

template <class Real>
void set_gravity_scale(WorldData<Real>& w, int body, double scale) {
  const Real wanted = static_cast<Real>(scale);
  if (w.uncommon_of(body).gravity_scale != wanted) make_uncommon(w, body).gravity_scale = wanted;
}

template <class Real>
void set_damping(WorldData<Real>& w, int body, double linear, double angular) {
  const Real wanted = static_cast<Real>(linear), wanted_angular = static_cast<Real>(angular);
  const UncommonBody<Real>& now = w.uncommon_of(body);
  if (now.linear_damping == wanted && now.angular_damping == wanted_angular) return;
  UncommonBody<Real>& own = make_uncommon(w, body);
  own.linear_damping = wanted, own.angular_damping = wanted_angular;
}

template <class Real>
void place_body(WorldData<Real>& w, int body, Vec2d origin, double angle) {
  wake_neighbours(w, body);
  BodyRecord<Real>& record = w.bodies[body];
  record.angle = angle;
  w.rotation[body] = rounded<Real>(rotation_of(angle));
  w.position[body] = origin + (w.rotation[body] * record.centre).template as<double>();
  w.motion[body].moved = {}, w.motion[body].turned = 0;
  w.remainders.renew(body, w.bodies.size());
  forget_manifolds(w, body);
  for_each_edge(w.joints, record.first_joint,
                [&](int, JointRecord& joint) { w.joint_set.forget(joint.slot); });
  for (int shape = record.first_shape; shape != kNone; shape = w.shapes[shape].next) {
    leave_tree(w, shape);
    enter_tree(w, shape);
  }
  w.enlarged[body] = 1;
}

template <class Real>
void set_type(WorldData<Real>& w, int body, BodyType type) {
  BodyRecord<Real>& record = w.bodies[body];
  if (record.quarantined) {
    quarantine_of(w, body).type = type;
    return;
  }
  if (record.type == type) return;
  wake_neighbours(w, body);
  destroy_contacts_of(w, body);
  for (int shape = record.first_shape; shape != kNone; shape = w.shapes[shape].next) leave_tree(w, shape);
  if (record.awake) leave_awake(w, body);
  record.type = type;
  w.remainders.renew(body, w.bodies.size());
  if (type != BodyType::Static) enter_awake(w, body);
  if (type == BodyType::Static) w.motion[body] = {};
  if (record.mass_given) {
    apply_mass(w, body, {double(record.mass), record.centre.template as<double>(), double(record.inertia)});
  } else {
    update_mass(w, body);
  }
  for_each_edge(w.joints, record.first_joint, [&](int, JointRecord& joint) {
    w.joint_set.set_dynamic(joint.slot, w.gives_way(joint.body_a), w.gives_way(joint.body_b));
  });
  for (int shape = record.first_shape; shape != kNone; shape = w.shapes[shape].next) enter_tree(w, shape);
}

template <class Real>
void require_weights(const WorldData<Real>& w, int body) {
  if (std::is_same_v<Real, double>) return;
  for (int shape = w.bodies[body].first_shape; shape != kNone; shape = w.shapes[shape].next) {
    const double density = static_cast<double>(w.shapes[shape].density);
    if (!w.forms[shape].chain && density != 0) require_weight(density, mass_of(w, shape));
  }
}

// A dynamic body whose shapes have no mass weighs 1 kg and does not turn: it could not be moved otherwise.
template <class Real>
void update_mass(WorldData<Real>& w, int body) {
  const BodyRecord<Real>& record = w.bodies[body];
  if (record.mass_given) return update_extents(w, body);
  double mass = 0, inertia = 0;
  Vec2d moment{};
  std::vector<ConvexMass>& parts = w.scratch.mass_parts;
  parts.clear();
  for (int shape = record.first_shape; shape != kNone; shape = w.shapes[shape].next) {
    if (w.forms[shape].chain || w.shapes[shape].density == 0) continue;
    parts.push_back(mass_of(w, shape));
    mass += parts.back().mass;
    moment += parts.back().mass * parts.back().centroid;
  }
  // Where the reciprocal is no number, what there is does not count.
  if (!(mass > 0 && 1 / mass <= std::numeric_limits<double>::max()))
    return apply_mass(w, body, {1, record.centre.template as<double>(), 0});
  const Vec2d centre = (1 / mass) * moment;  // seen from the centre so far
  for (const ConvexMass& part : parts) {
    inertia += part.inertia + part.mass * length_squared(part.centroid - centre);
  }
  apply_mass(w, body, {mass, record.centre.template as<double>() + centre, inertia});
}

template <class Real>
void set_mass(WorldData<Real>& w, int body, const MassProperties& mass) {
  w.bodies[body].mass_given = true;
  apply_mass(w, body, mass);
}

#define PLUMB_FOR(Real)                                                                             \
  template int add_body(WorldData<Real>&, const BodyDefinition&, std::span<const ShapeDefinition>); \
  template void remove_body(WorldData<Real>&, int);                                                 \
  template Vec2d origin_of(const WorldData<Real>&, int);                                            \
  template void set_gravity_scale(WorldData<Real>&, int, double);                                   \
  template void set_damping(WorldData<Real>&, int, double, double);                                 \
  template void place_body(WorldData<Real>&, int, Vec2d, double);                                   \
  template void set_type(WorldData<Real>&, int, BodyType);                                          \
  template void require_weights(const WorldData<Real>&, int);                                       \
  template void update_mass(WorldData<Real>&, int);                                                 \
  template void set_mass(WorldData<Real>&, int, const MassProperties&);
PLUMB_FOR(float)
PLUMB_FOR(double)
#undef PLUMB_FOR

}  // namespace plumb
