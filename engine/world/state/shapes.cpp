#include <algorithm>
#include <limits>
#include <utility>

#include "engine/geometry/convex_bounds.h"
#include "engine/geometry/convex_hull.h"
#include "engine/math/trigonometry.h"
#include "engine/world/state/bodies.h"
#include "engine/world/state/contact_setup.h"
#include "engine/world/state/contacts.h"
#include "engine/world/state/mass.h"
#include "engine/world/state/naming.h"
#include "engine/world/state/new_shape.h"
#include "engine/world/state/shape_boxes.h"
#include "engine/world/state/sleeping.h"

namespace plumb {
namespace {

struct Outline {
  Corners corners;
  double radius = 0;
};

struct MakeOutline {
  double spacing = 0;  // relative, of the numbers that will hold the corners
  Vec2d position{};    // m, in the body's frame
  Outline operator()(const Circle& circle) const { return {disc_corner({}), circle.radius}; }
  Outline operator()(const Box& box) const { return {box_corners(box.width / 2, box.height / 2), 0}; }
  Outline operator()(const Capsule& capsule) const {
    return {capsule_corners(capsule.start, capsule.end), capsule.radius};
  }
  Outline operator()(const Polygon& polygon) const {
    return {convex_hull(polygon.points, outline_rounding(polygon.points, spacing, position)), polygon.radius};
  }
  Outline operator()(const Segment& segment) const {
    return {capsule_corners(segment.start, segment.end), 0};
  }
};

// Removes duplicates and stale entries, left by shapes destroyed since the last step, from the move buffer.
template <class Real>
void compact_move_buffer(WorldData<Real>& w) {
  std::erase_if(w.move_buffer, [&](int shape) { return !std::exchange(w.shapes[shape].moved, false); });
  for (const int shape : w.move_buffer) w.shapes[shape].moved = true;
}

template <class Real>
void set_coefficients(ShapeRecord<Real>& record, const Material& material) {
  record.friction = static_cast<Real>(material.friction);
  record.restitution = static_cast<Real>(material.restitution);
  record.rolling_resistance = static_cast<Real>(material.rolling_resistance);
  record.surface_speed = static_cast<Real>(material.surface_speed);
}

// Stores a shape's corners and sizes, in the frame of its body's centre of mass.
template <class Real>
void store_form(WorldData<Real>& w, int body, int shape, const NewShape<Real>& made) {
  const Vec2d shift = -w.bodies[body].centre.template as<double>();
  Corner<Real> corners[kMaxCorners + 2];
  for (std::size_t i = 0; i < made.corners.size(); ++i) {
    corners[i] = {(made.corners[i].point + shift).template as<Real>(),
                  made.corners[i].normal.template as<Real>()};
  }
  ShapeForm<Real>& form = w.forms[shape];
  form = made.form;
  form.corner = w.corners.add({corners, made.corners.size()});
  form.count = static_cast<std::uint16_t>(made.count);
  const Convex<Real> convex = w.convex(shape);
  Vec2<Real> middle{};
  for (int i = 0; i < made.count; ++i)
    middle += (Real(1) / static_cast<Real>(made.count)) * convex.corners[i].point;
  form.extent = convex_extent(convex, middle);
}

// Calls visit(edge, contact) for the contacts of one shape.
template <class Real, class Visit>
void for_each_contact_of(WorldData<Real>& w, int shape, const Visit& visit) {
  for_each_edge(w.contacts, w.bodies[w.shapes[shape].body].first_contact,
                [&](int edge, ContactRecord& contact) {
                  if (contact.shape_a == shape || contact.shape_b == shape) visit(edge, contact);
                });
}

// Reserves memory to end a shape's contacts and to insert it into its tree again.
template <class Real>
void reserve_renewal(WorldData<Real>& w, int shape) {
  w.tree_of(w.bodies[w.shapes[shape].body].type).reserve_more(1);
  ensure_capacity(w.move_buffer, w.move_buffer.size() + 1);
  std::size_t contacts = 0;
  for_each_contact_of(w, shape, [&](int, const ContactRecord&) { ++contacts; });
  ensure_capacity(w.event_buffer().end, w.event_buffer().end.size() + contacts);
}

}  // namespace

template <class Real>
NewShape<Real> prepare_shape(const ShapeDefinition& definition) {
  NewShape<Real> made;
  Outline outline =
      std::visit(MakeOutline{static_cast<double>(std::numeric_limits<Real>::epsilon()), definition.position},
                 definition.geometry);
  made.corners =
      transformed(outline.corners, Pose<double>{definition.position, rotation_of(definition.angle)});
  made.count = static_cast<int>(made.corners.size());
  made.form.sensor = definition.sensor;
  made.form.radius = static_cast<Real>(outline.radius);
  set_coefficients(made.record, definition.material);
  made.record.filter = definition.filter;
  made.record.density = static_cast<Real>(definition.density);
  made.record.hit_events = definition.hit_events, made.record.pre_solve = definition.pre_solve;
  made.user_data = definition.user_data;
  return made;
}

template <class Real>
NewShape<Real> prepare_segment(const ChainDefinition& definition, int index) {
  const std::vector<Vec2d>& points = definition.points;
  const int count = static_cast<int>(points.size());
  // Returns the vertex at `i`. An open end is its own neighbour, which makes it a corner.
  const auto vertex = [&](int i) {
    if (definition.closed) return points[static_cast<std::size_t>((i + count) % count)];
    return points[static_cast<std::size_t>(std::clamp(i, 0, count - 1))];
  };
  NewShape<Real> made;
  const Corners segment = capsule_corners(vertex(index), vertex(index + 1));
  made.corners = {{vertex(index - 1), {}}, segment[0], segment[1], {vertex(index + 2), {}}};
  made.count = 2;  // two of the four corners are the segment's own
  made.form.chain = true;
  made.form.sensor = definition.sensor;
  const std::size_t segment_index = static_cast<std::size_t>(index);
  set_coefficients(made.record,
                   definition.materials.empty() ? definition.material : definition.materials[segment_index]);
  made.record.filter = definition.filter;
  made.record.hit_events = definition.hit_events, made.record.pre_solve = definition.pre_solve;
  made.user_data = definition.user_data;
  return made;
}

template <class Real>
void reserve_shapes(WorldData<Real>& w, BodyType type, std::span<const NewShape<Real>> shapes) {
  const std::size_t more = shapes.size(), all = static_cast<std::size_t>(w.shapes.size()) + more;
  typename CornerPool<Real>::Runs runs{};
  std::size_t sensors = 0;
  bool data = false;
  for (const NewShape<Real>& shape : shapes) {
    ++runs[shape.corners.size()];
    sensors += shape.form.sensor ? 1 : 0;
    data = data || shape.user_data != 0;
  }
  w.shapes.reserve_more(more);
  ensure_capacity(w.forms, all), ensure_capacity(w.tight_aabbs, all);
  w.shape_data.reserve(static_cast<int>(all), data);
  w.corners.reserve_runs(runs);
  ensure_capacity(w.sensors, w.sensors.size() + sensors);
  w.tree_of(type).reserve_more(more);
  if (w.move_buffer.size() > 2 * all) compact_move_buffer(w);
  ensure_capacity(w.move_buffer, w.move_buffer.size() + more);
}

template <class Real>
int insert_shape(WorldData<Real>& w, int body, const NewShape<Real>& made) {
  const int shape = w.shapes.add(made.record);
  resize_with_growth(w.forms, w.shapes.size()), resize_with_growth(w.tight_aabbs, w.shapes.size());
  w.shape_data.reset(shape, w.shapes.size());
  if (made.user_data != 0) w.shape_data.at(shape, w.shapes.size()) = made.user_data;
  store_form(w, body, shape, made);
  ShapeRecord<Real>& record = w.shapes[shape];
  record.body = body;
  record.next = w.bodies[body].first_shape;
  if (record.next != kNone) w.shapes[record.next].previous = shape;
  w.bodies[body].first_shape = shape;
  w.reports_hits = w.reports_hits || record.hit_events;
  if (made.form.sensor) w.sensors.push_back({shape, {}});
  return shape;
}

template <class Real>
void add_to_move_buffer(WorldData<Real>& w, int shape) {
  ShapeRecord<Real>& record = w.shapes[shape];
  if (record.moved) return;
  if (w.move_buffer.size() > 2 * static_cast<std::size_t>(w.shapes.size()) + 64) compact_move_buffer(w);
  append(w.move_buffer, shape);
  record.moved = true;
}

template <class Real>
void create_proxy(WorldData<Real>& w, int shape) {
  ShapeRecord<Real>& record = w.shapes[shape];
  w.tight_aabbs[shape] = tight_aabb(w, shape);
  if (w.bodies[record.body].quarantined || collides_with_nothing(record.filter)) return;
  record.proxy = w.tree_of(w.bodies[record.body].type)
                     .insert(fat_aabb(w, shape, Real(0)), folded(record.filter.category), shape);
  add_to_move_buffer(w, shape);
}

template <class Real>
void destroy_proxy(WorldData<Real>& w, int shape) {
  ShapeRecord<Real>& record = w.shapes[shape];
  if (record.proxy == kNone) return;  // not in a tree: in quarantine, or collides with nothing
  w.tree_of(w.bodies[record.body].type).remove(record.proxy);
  record.proxy = kNone;
}

template <class Real>
void erase_shape(WorldData<Real>& w, int shape) {
  ShapeRecord<Real>& record = w.shapes[shape];
  if (w.forms[shape].sensor) end_overlaps(w, shape);
  destroy_proxy(w, shape);
  const ShapeForm<Real>& form = w.forms[shape];
  w.corners.remove(form.corner, form.stored());
  BodyRecord<Real>& body = w.bodies[record.body];
  (record.previous == kNone ? body.first_shape : w.shapes[record.previous].next) = record.next;
  if (record.next != kNone) w.shapes[record.next].previous = record.previous;
  w.shapes.remove(shape);
}

template <class Real>
int add_shape(WorldData<Real>& w, int body, const ShapeDefinition& definition) {
  const NewShape<Real> made = prepare_shape<Real>(definition);
  reserve_shapes<Real>(w, w.bodies[body].type, {&made, 1});
  wake_body(w, body);
  record_mass_change(w, body);
  const int shape = insert_shape(w, body, made);
  grow_extents(w, body, shape);
  create_proxy(w, shape);
  wake_touched(w, shape);
  return shape;
}

template <class Real>
void remove_shape(WorldData<Real>& w, int shape) {
  const int body = w.shapes[shape].body;
  wake_body(w, body);
  record_mass_change(w, body);
  destroy_contacts_of(w, body, shape);
  erase_shape(w, shape);
}

template <class Real>
void set_geometry(WorldData<Real>& w, int shape, const ShapeDefinition& definition) {
  const int body = w.shapes[shape].body;
  NewShape<Real> made = prepare_shape<Real>(definition);
  made.form.sensor = w.forms[shape].sensor;
  typename CornerPool<Real>::Runs runs{};
  ++runs[made.corners.size()];
  w.corners.reserve_runs(runs);
  reserve_renewal(w, shape);
  wake_body(w, body);
  record_mass_change(w, body);
  destroy_contacts_of(w, body, shape);
  destroy_proxy(w, shape);
  w.corners.remove(w.forms[shape].corner, w.forms[shape].stored());
  store_form(w, body, shape, made);
  grow_extents(w, body, shape);
  create_proxy(w, shape);
  wake_touched(w, shape);
}

template <class Real>
void set_filter(WorldData<Real>& w, int shape, const Filter& filter) {
  reserve_renewal(w, shape);
  wake_body(w, w.shapes[shape].body);
  w.shapes[shape].filter = filter;
  destroy_forbidden_contacts(w, shape);
  destroy_proxy(w, shape);
  create_proxy(w, shape);
  wake_touched(w, shape);
}

// Contacts contain the old material: mixes their coefficients again, first on a copy, because a user's
// combine rule may throw.
template <class Real>
void set_material(WorldData<Real>& w, int shape, const Material& material) {
  const ShapeRecord<Real> before = w.shapes[shape];
  set_coefficients(w.shapes[shape], material);
  try {
    for_each_contact_of(w, shape, [&](int, const ContactRecord& contact) {
      ContactConstraint<Real> trial;
      mix_materials(w, contact, trial);
    });
    wake_body(w, before.body);
    for_each_contact_of(w, shape, [&](int edge, const ContactRecord& contact) {
      if (has_points(contact)) wake_body(w, (edge & 1) == 0 ? contact.body_b : contact.body_a);
    });
  } catch (...) {
    w.shapes[shape] = before;
    throw;
  }
  for_each_contact_of(w, shape, [&](int, const ContactRecord& contact) {
    if (has_points(contact)) mix_materials(w, contact, constraint_of(w, contact));
  });
}

template <class Real>
void set_density(WorldData<Real>& w, int shape, double density) {
  const int body = w.shapes[shape].body;
  const Real before = std::exchange(w.shapes[shape].density, static_cast<Real>(density));
  if (w.is_dynamic(body) && !w.bodies[body].mass_given) {
    try {
      with_part_subject(w, "shape", body, [&] { require_float_masses(w, body); });
    } catch (...) {
      w.shapes[shape].density = before;
      throw;
    }
  }
  record_mass_change(w, body);
  wake_body(w, body);
}

template <class Real>
void set_sensor(WorldData<Real>& w, int shape, bool sensor) {
  if (w.forms[shape].sensor == sensor) return;
  const int body = w.shapes[shape].body;
  w.tree_of(w.bodies[body].type).reserve_more(1);
  ensure_capacity(w.move_buffer, w.move_buffer.size() + 1);
  ensure_capacity(w.sensors, w.sensors.size() + 1);
  wake_body(w, body);
  if (sensor) {
    destroy_contacts_of(w, body, shape);
    w.sensors.push_back({shape, {}});
  } else {
    end_overlaps(w, shape);
  }
  w.forms[shape].sensor = sensor;
  destroy_proxy(w, shape);
  create_proxy(w, shape);
  wake_touched(w, shape);
}

template <class Real>
void set_flags(WorldData<Real>& w, int shape, bool hit_events, bool pre_solve) {
  ShapeRecord<Real>& record = w.shapes[shape];
  // Recycled manifolds would not call the hook.
  if (record.pre_solve != pre_solve)
    wake_body(w, record.body), wake_touched(w, shape), invalidate_manifolds(w, record.body);
  record.hit_events = hit_events, record.pre_solve = pre_solve;
  w.reports_hits = w.reports_hits || hit_events;
  for_each_contact_of(w, shape, [&](int, ContactRecord& contact) {
    const ShapeRecord<Real>&a = w.shapes[contact.shape_a], &b = w.shapes[contact.shape_b];
    contact.hit_events = a.hit_events || b.hit_events;
    contact.pre_solve = a.pre_solve || b.pre_solve;
    if (!has_points(contact)) return;
    ContactConstraint<Real>& c = constraint_of(w, contact);
    if (c.tracking == ImpactTracking::Off) c.step_impulse = 0;  // left from an earlier step
    c.tracking = tracking_of(contact, c);
  });
}

#define PLUMB_FOR(Real)                                                                      \
  template NewShape<Real> prepare_shape(const ShapeDefinition&);                             \
  template NewShape<Real> prepare_segment(const ChainDefinition&, int);                      \
  template void reserve_shapes(WorldData<Real>&, BodyType, std::span<const NewShape<Real>>); \
  template int insert_shape(WorldData<Real>&, int, const NewShape<Real>&);                   \
  template void add_to_move_buffer(WorldData<Real>&, int);                                   \
  template void create_proxy(WorldData<Real>&, int);                                         \
  template void destroy_proxy(WorldData<Real>&, int);                                        \
  template void erase_shape(WorldData<Real>&, int);                                          \
  template int add_shape(WorldData<Real>&, int, const ShapeDefinition&);                     \
  template void remove_shape(WorldData<Real>&, int);                                         \
  template void set_geometry(WorldData<Real>&, int, const ShapeDefinition&);                 \
  template void set_filter(WorldData<Real>&, int, const Filter&);                            \
  template void set_material(WorldData<Real>&, int, const Material&);                        \
  template void set_density(WorldData<Real>&, int, double);                                  \
  template void set_sensor(WorldData<Real>&, int, bool);                                     \
  template void set_flags(WorldData<Real>&, int, bool, bool);
PLUMB_FOR(float)
PLUMB_FOR(double)
#undef PLUMB_FOR

}  // namespace plumb
