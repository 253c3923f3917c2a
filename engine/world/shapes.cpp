#include <algorithm>
#include <cmath>

#include "engine/geometry/convex_bounds.h"
#include "engine/geometry/convex_hull.h"
#include "engine/math/trigonometry.h"
#include "engine/world/bodies.h"
#include "engine/world/contacts.h"
#include "engine/world/islands.h"
#include "engine/world/step.h"

namespace plumb {
namespace {

struct Outline {
  Corners corners;
  double radius = 0;
};

struct MakeOutline {
  Outline operator()(const Circle& circle) const { return {disc_corner({}), circle.radius}; }
  Outline operator()(const Box& box) const { return {box_corners(box.width / 2, box.height / 2), 0}; }
  Outline operator()(const Capsule& capsule) const {
    return {capsule_corners(capsule.start, capsule.end), capsule.radius};
  }
  Outline operator()(const Polygon& polygon) const { return {convex_hull(polygon.points), polygon.radius}; }
  Outline operator()(const Segment& segment) const {
    return {capsule_corners(segment.start, segment.end), 0};
  }
};

// The shape's corners in the frame of its body's centre of mass, and what follows from them.
template <class Real>
int insert(WorldData<Real>& w, int body, const Corners& corners, int count, const ShapeForm<Real>& form_like,
           const ShapeRecord<Real>& record_like, std::uint64_t user_data) {
  const int shape = w.shapes.add(record_like);
  make_room(w.forms, w.shapes.size()), make_room(w.boxes, w.shapes.size());
  w.shape_data.renew(shape, w.shapes.size());
  if (user_data != 0) w.shape_data.at(shape, w.shapes.size()) = user_data;
  ShapeForm<Real>& form = w.forms[shape];
  form = form_like;
  const Corners local = translated(corners, -w.bodies[body].centre.template as<double>());
  form.corner = w.corners.add(rounded_to<Real>(local));
  form.count = static_cast<std::uint16_t>(count);
  const Convex<Real> convex = w.convex(shape);
  Vec2<Real> middle{};
  for (int i = 0; i < count; ++i) middle += (Real(1) / static_cast<Real>(count)) * convex.corners[i].point;
  form.extent = convex_extent(convex, middle);
  ShapeRecord<Real>& record = w.shapes[shape];
  record.body = body;
  record.next = w.bodies[body].first_shape;
  w.bodies[body].first_shape = shape;
  return shape;
}

template <class Real>
void put_material(ShapeRecord<Real>& record, const Material& material) {
  record.friction = static_cast<float>(material.friction);
  record.restitution = static_cast<float>(material.restitution);
  record.rolling_resistance = static_cast<float>(material.rolling_resistance);
  record.surface_speed = static_cast<float>(material.surface_speed);
}

template <class Real>
bool is_sensor(const WorldData<Real>& w, int shape) {
  return w.forms[shape].sensor;
}

}  // namespace

template <class Real>
void enter_tree(WorldData<Real>& w, int shape) {
  ShapeRecord<Real>& record = w.shapes[shape];
  w.boxes[shape] = box_of(w, shape);
  if (w.bodies[record.body].quarantined || meets_nothing(record.filter)) return;
  record.proxy = w.tree_of(w.bodies[record.body].type)
                     .insert(stored_box(w, shape, Real(0)), record.filter.category, shape);
  if (!record.moved) append(w.moved_shapes, shape);
  record.moved = true;
}

template <class Real>
void leave_tree(WorldData<Real>& w, int shape) {
  ShapeRecord<Real>& record = w.shapes[shape];
  if (record.proxy == kNone) return;  // in quarantine, or meets nothing
  w.tree_of(w.bodies[record.body].type).remove(record.proxy);
  record.proxy = kNone;
}

template <class Real>
int insert_shape(WorldData<Real>& w, int body, const ShapeDefinition& definition) {
  const Outline outline = std::visit(MakeOutline{}, definition.geometry);
  const Corners corners =
      transformed(outline.corners, Pose<double>{definition.position, rotation_of(definition.angle)});
  ShapeForm<Real> form;
  form.sensor = definition.sensor;
  form.radius = static_cast<Real>(outline.radius);
  ShapeRecord<Real> record;
  put_material(record, definition.material);
  record.filter = definition.filter;
  record.density = static_cast<Real>(definition.density);
  record.hit_events = definition.hit_events, record.pre_solve = definition.pre_solve;
  w.reports_hits = w.reports_hits || definition.hit_events;
  const int shape =
      insert(w, body, corners, static_cast<int>(corners.size()), form, record, definition.user_data);
  if (definition.sensor) w.sensors.push_back({shape, {}});
  return shape;
}

template <class Real>
void take_out_shape(WorldData<Real>& w, int shape) {
  ShapeRecord<Real>& record = w.shapes[shape];
  destroy_contacts_of(w, record.body, shape);
  leave_tree(w, shape);
  const ShapeForm<Real>& form = w.forms[shape];
  w.corners.remove(form.corner, form.stored());
  if (is_sensor(w, shape)) {
    std::erase_if(w.sensors, [&](const SensorRecord& sensor) { return sensor.shape == shape; });
  }
  BodyRecord<Real>& body = w.bodies[record.body];
  int* link = &body.first_shape;
  while (*link != shape) link = &w.shapes[*link].next;
  *link = record.next;
  w.shapes.remove(shape);
}

template <class Real>
int add_shape(WorldData<Real>& w, int body, const ShapeDefinition& definition) {
  wake_neighbours(w, body);
  const int shape = insert_shape(w, body, definition);
  update_mass(w, body);
  enter_tree(w, shape);
  return shape;
}

template <class Real>
void remove_shape(WorldData<Real>& w, int shape) {
  const int body = w.shapes[shape].body;
  wake_neighbours(w, body);
  take_out_shape(w, shape);
  update_mass(w, body);
}

template <class Real>
void set_filter(WorldData<Real>& w, int shape, const Filter& filter) {
  wake_neighbours(w, w.shapes[shape].body);
  destroy_contacts_of(w, w.shapes[shape].body, shape);
  w.shapes[shape].filter = filter;
  leave_tree(w, shape);
  enter_tree(w, shape);
}

template <class Real>
void set_material(WorldData<Real>& w, int shape, const Material& material) {
  wake_neighbours(w, w.shapes[shape].body);
  put_material(w.shapes[shape], material);
  // Contacts mixed the old one in: they are made anew.
  destroy_contacts_of(w, w.shapes[shape].body, shape);
  leave_tree(w, shape);
  enter_tree(w, shape);
}

template <class Real>
int add_chain(WorldData<Real>& w, int body, const ChainDefinition& definition) {
  const std::vector<Vec2d>& points = definition.points;
  const int count = static_cast<int>(points.size());
  const int chain = w.chains.add({body, {}});
  // The vertex at `i`; an open end is its own neighbour: a corner.
  const auto vertex = [&](int i) {
    if (definition.closed) return points[static_cast<std::size_t>((i + count) % count)];
    i = std::clamp(i, 0, count - 1);
    return points[static_cast<std::size_t>(i)];
  };
  for (int i = 0; i < (definition.closed ? count : count - 1); ++i) {
    const Corners segment = capsule_corners(vertex(i), vertex(i + 1));
    const Corners corners = {{vertex(i - 1), {}}, segment[0], segment[1], {vertex(i + 2), {}}};
    ShapeForm<Real> form;
    form.chain = true;
    ShapeRecord<Real> record;
    put_material(record, definition.material);
    record.filter = definition.filter;
    record.chain = chain;
    // Four corners are stored, two of them are the segment's.
    const int shape = insert(w, body, corners, 2, form, record, definition.user_data);
    w.chains[chain].shapes.push_back(shape);
  }
  update_mass(w, body);
  for (const int shape : w.chains[chain].shapes) enter_tree(w, shape);
  return chain;
}

template <class Real>
void remove_chain(WorldData<Real>& w, int chain) {
  const int body = w.chains[chain].body;
  wake_neighbours(w, body);
  for (const int shape : w.chains[chain].shapes) take_out_shape(w, shape);
  w.chains.remove(chain);
  update_mass(w, body);
}

#define PLUMB_FOR(Real)                                                     \
  template void enter_tree(WorldData<Real>&, int);                          \
  template void leave_tree(WorldData<Real>&, int);                          \
  template int insert_shape(WorldData<Real>&, int, const ShapeDefinition&); \
  template void take_out_shape(WorldData<Real>&, int);                      \
  template int add_shape(WorldData<Real>&, int, const ShapeDefinition&);    \
  template void remove_shape(WorldData<Real>&, int);                        \
  template void set_filter(WorldData<Real>&, int, const Filter&);           \
  template void set_material(WorldData<Real>&, int, const Material&);       \
  template int add_chain(WorldData<Real>&, int, const ChainDefinition&);    \
  template void remove_chain(WorldData<Real>&, int);
PLUMB_FOR(float)
PLUMB_FOR(double)
#undef PLUMB_FOR

}  // namespace plumb
