#include "engine/world/state/mass.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <type_traits>

#include "engine/core/capacity.h"
#include "engine/geometry/convex_bounds.h"
#include "engine/geometry/convex_core.h"
#include "engine/geometry/convex_mass.h"
#include "engine/world/state/bodies.h"
#include "engine/world/state/contacts.h"
#include "engine/world/state/quarantine.h"
#include "engine/world/state/validate.h"

namespace plumb {
namespace {

// Moves the origin of the frame in which corners and anchors are stored to `centre`.
template <class Real>
void recentre(WorldData<Real>& w, int body, Vec2<Real> centre) {
  BodyRecord<Real>& record = w.bodies[body];
  const Vec2<Real> displacement = centre - record.centre;
  if (displacement == Vec2<Real>{}) return;
  typename CornerPool<Real>::Runs runs{};
  for (int shape = record.first_shape; shape != kNone; shape = w.shapes[shape].next)
    ++runs[static_cast<std::size_t>(w.forms[shape].stored())];
  w.corners.reserve_runs(runs);  // nothing below allocates
  for (int shape = record.first_shape; shape != kNone; shape = w.shapes[shape].next) {
    ShapeForm<Real>& form = w.forms[shape];
    Corner<Real> moved[kMaxCorners + 2];
    const auto corners = w.corners.run(form.corner, form.stored());
    std::copy(corners.begin(), corners.end(), moved);
    for (int i = 0; i < form.stored(); ++i) moved[i].point -= displacement;
    w.corners.remove(form.corner, form.stored());
    form.corner = w.corners.add({moved, corners.size()});
  }
  const Vec2<Real> arm = w.rotation[body] * displacement;
  w.motion[body].velocity += cross(w.motion[body].angular_velocity, arm);  // velocity of the new centre
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
    half_width = std::min(half_width, convex_tunnelling_width(w.convex(shape)));
  }
  w.extents[body] = extent;
  record.half_width = half_width;
}

// Clamps masses to the largest finite number: a mass or the inverse of one may exceed it.
template <class Real>
Real clamp_finite(double x) {
  return static_cast<Real>(std::min<double>(x, std::numeric_limits<Real>::max()));
}

template <class Real>
void apply_mass(WorldData<Real>& w, int body, const MassProperties& mass, Vec2<Real> frame) {
  BodyRecord<Real>& record = w.bodies[body];
  SolverBody<Real>& motion = w.motion[body];
  assert(mass.mass > 0 && mass.inertia >= 0);
  recentre(w, body, frame);
  w.topology_changed = true;
  record.mass = clamp_finite<Real>(mass.mass), record.inertia = clamp_finite<Real>(mass.inertia);
  const bool dynamic = own_type(w, body) == BodyType::Dynamic;
  motion.inverse_mass = dynamic ? inverse_mass_of(record, mass.mass) : Real(0);
  motion.inverse_inertia =
      dynamic && !record.lock_rotation && mass.inertia > 0 ? clamp_finite<Real>(1 / mass.inertia) : Real(0);
  if (dynamic && record.lock_rotation)
    motion.angular_velocity = 0;  // a kinematic body that became dynamic may have one
  update_extents(w, body);
  invalidate_manifolds(w, body);
}

template <class Real>
Vec2<Real> frame_for(const WorldData<Real>& w, int body, const MassProperties& mass) {
  return own_type(w, body) == BodyType::Kinematic ? Vec2<Real>{} : mass.centre.as<Real>();
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

// Calls visit(part) with the mass properties of each shape that has mass.
template <class Real, class Visit>
void for_each_part(const WorldData<Real>& w, int body, const Visit& visit) {
  for (int shape = w.bodies[body].first_shape; shape != kNone; shape = w.shapes[shape].next) {
    if (!w.forms[shape].chain && w.shapes[shape].density != 0) visit(mass_of(w, shape));
  }
}

}  // namespace

template <class Real>
Real inverse_mass_of(const BodyRecord<Real>& record, double mass) {
  return record.lock_x && record.lock_y ? Real(0) : clamp_finite<Real>(1 / mass);
}

// A body whose shapes have no mass gets 1 kg and does not rotate; without a mass it could not be moved.
template <class Real>
MassProperties current_mass(const WorldData<Real>& w, int body) {
  const BodyRecord<Real>& record = w.bodies[body];
  if (record.mass_given)
    return {static_cast<double>(record.mass), w.extras_of(body).mass_centre.template as<double>(),
            static_cast<double>(record.inertia)};
  double mass = 0, inertia = 0;
  Vec2d moment{};
  for_each_part(w, body, [&](const ConvexMass& part) {
    mass += part.mass;
    moment += part.mass * part.centroid;
  });
  // A mass whose inverse is not finite counts as no mass.
  if (!(mass > 0 && 1 / mass <= std::numeric_limits<double>::max()))
    return {1, record.centre.template as<double>(), 0};
  const Vec2d centre = (1 / mass) * moment;  // in the body's frame
  // The corners of a damaged snapshot may give any numbers.
  if (!std::isfinite(centre.x) || !std::isfinite(centre.y))
    return {1, record.centre.template as<double>(), 0};
  for_each_part(w, body, [&](const ConvexMass& part) {
    inertia += part.inertia + part.mass * length_squared(part.centroid - centre);
  });
  // The corners of a damaged snapshot may be in clockwise order: a negative inertia counts as none.
  return {mass, record.centre.template as<double>() + centre, inertia >= 0 ? inertia : 0};
}

template <class Real>
void update_mass(WorldData<Real>& w, int body) {
  if (w.bodies[body].mass_given) return update_extents(w, body);
  const MassProperties mass = current_mass(w, body);
  apply_mass(w, body, mass, frame_for(w, body, mass));
}

template <class Real>
void update_mass_for_type(WorldData<Real>& w, int body) {
  const MassProperties mass = current_mass(w, body);
  const bool stays = own_type(w, body) == BodyType::Static;
  apply_mass(w, body, mass, stays ? w.bodies[body].centre : frame_for(w, body, mass));
}

template <class Real>
void set_mass(WorldData<Real>& w, int body, const MassProperties& mass) {
  const Vec2<Real> centre = mass.centre.as<Real>();
  if (w.extras_of(body).mass_centre != centre) make_extras(w, body).mass_centre = centre;
  apply_mass(w, body, mass, frame_for(w, body, mass));
  w.bodies[body].mass_given = true;
}

template <class Real>
void record_mass_change(WorldData<Real>& w, int body) {
  BodyRecord<Real>& record = w.bodies[body];
  if (own_type(w, body) == BodyType::Static) {
    if (!record.mass_given) record.mass = -1;  // unknown
    return;
  }
  if (has_mass_change(w, body)) return;
  append(w.mass_changed_bodies, body);
  record.half_width = -1;
}

template <class Real>
void grow_extents(WorldData<Real>& w, int body, int shape) {
  BodyRecord<Real>& record = w.bodies[body];
  w.extents[body] = std::max(w.extents[body], convex_extent(w.convex(shape), Vec2<Real>{}));
  if (has_mass_change(w, body)) return;
  const Real half_width = convex_tunnelling_width(w.convex(shape));
  const bool only_shape = record.first_shape == shape && w.shapes[shape].next == kNone;
  record.half_width = only_shape ? half_width : std::min(record.half_width, half_width);
}

template <class Real>
void apply_mass_changes(WorldData<Real>& w) {
  while (!w.mass_changed_bodies.empty()) {
    update_mass(w, w.mass_changed_bodies.back());
    w.mass_changed_bodies.pop_back();
  }
}

template <class Real>
Vec2<Real> centre_of_mass_shift(const WorldData<Real>& w, int body) {
  const BodyRecord<Real>& record = w.bodies[body];
  const bool known = !has_mass_change(w, body) && record.mass >= 0;
  if (known || own_type(w, body) == BodyType::Kinematic) return {};
  return current_mass(w, body).centre.template as<Real>() - record.centre;
}

template <class Real>
void require_float_masses(const WorldData<Real>& w, int body) {
  if (std::is_same_v<Real, double>) return;
  for (int shape = w.bodies[body].first_shape; shape != kNone; shape = w.shapes[shape].next) {
    const double density = static_cast<double>(w.shapes[shape].density);
    if (!w.forms[shape].chain && density != 0) require_float_mass(density, mass_of(w, shape));
  }
}

template <class Real>
void reserve_recentring(WorldData<Real>& w, std::span<const NewShape<Real>> shapes) {
  typename CornerPool<Real>::Runs runs{};
  for (const NewShape<Real>& shape : shapes) runs[shape.corners.size()] += 2;  // before and after
  w.corners.reserve_runs(runs);
}

#define PLUMB_FOR(Real)                                                  \
  template void update_mass(WorldData<Real>&, int);                      \
  template void update_mass_for_type(WorldData<Real>&, int);             \
  template void set_mass(WorldData<Real>&, int, const MassProperties&);  \
  template Real inverse_mass_of(const BodyRecord<Real>&, double);        \
  template void record_mass_change(WorldData<Real>&, int);               \
  template void grow_extents(WorldData<Real>&, int, int);                \
  template void apply_mass_changes(WorldData<Real>&);                    \
  template MassProperties current_mass(const WorldData<Real>&, int);     \
  template Vec2<Real> centre_of_mass_shift(const WorldData<Real>&, int); \
  template void require_float_masses(const WorldData<Real>&, int);       \
  template void reserve_recentring(WorldData<Real>&, std::span<const NewShape<Real>>);
PLUMB_FOR(float)
PLUMB_FOR(double)
#undef PLUMB_FOR

}  // namespace plumb
