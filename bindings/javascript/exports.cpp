// Functions called from JavaScript (plumb.mjs), over the C interface. Structures pass as numbers through one
// buffer, in the order of the structure's members: no layout of memory is known on the other side. Results of
// several numbers lie in the same buffer.
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <typeinfo>
#include <vector>

#include "bindings/c/include/plumb/plumb.h"
#include "engine/scene/error.h"

namespace {

std::vector<double> numbers(256);
std::vector<unsigned char> bytes;

/// Reads the buffer from its start.
class Reader {
 public:
  double number() { return numbers[at_++]; }
  bool flag() { return number() != 0; }
  int integer() { return static_cast<int>(number()); }
  std::uint32_t bits() { return static_cast<std::uint32_t>(number()); }
  std::uint64_t wide() {
    const std::uint64_t low = bits();
    return low | std::uint64_t{bits()} << 32;
  }
  plumb_vec2 point() {
    const double x = number();
    return {x, number()};
  }
  std::vector<plumb_vec2> points() {
    std::vector<plumb_vec2> all(bits());
    for (plumb_vec2& each : all) each = point();
    return all;
  }

 private:
  std::size_t at_ = 0;
};

/// Writes the buffer from its start.
class Writer {
 public:
  Writer() { numbers.clear(); }
  Writer& add(double value) {
    numbers.push_back(value);
    return *this;
  }
  Writer& add(plumb_vec2 v) { return add(v.x).add(v.y); }
  template <class Handle>
  Writer& id(Handle handle) {
    return add(handle.index).add(handle.generation);
  }
  double* done() const { return numbers.data(); }
};

plumb_material material(Reader& r) {
  plumb_material m{};
  m.friction = r.number(), m.restitution = r.number();
  m.rolling_resistance = r.number(), m.surface_speed = r.number();
  return m;
}
plumb_filter filter(Reader& r) {
  plumb_filter f{};
  f.category = r.bits(), f.mask = r.bits(), f.group = r.integer();
  return f;
}

/// A shape's definition and the points that it names.
struct ShapeInput {
  plumb_shape_definition definition = plumb_default_shape();
  std::vector<plumb_vec2> points;
};

plumb_geometry geometry(Reader& r, std::vector<plumb_vec2>& points) {
  plumb_geometry g{};
  g.kind = static_cast<plumb_shape_kind>(r.integer());
  g.radius = r.number(), g.width = r.number(), g.height = r.number();
  g.start = r.point(), g.end = r.point();
  points = r.points();
  g.points = points.data(), g.point_count = points.size();
  return g;
}

void read(Reader& r, ShapeInput& shape) {
  plumb_shape_definition& d = shape.definition;
  d.geometry = geometry(r, shape.points);
  d.position = r.point(), d.angle = r.number(), d.density = r.number();
  d.material = material(r), d.filter = filter(r);
  d.sensor = r.flag(), d.hit_events = r.flag(), d.pre_solve = r.flag();
  d.user_data = r.wide();
}

plumb_query_filter query(Reader& r) {
  plumb_query_filter f = plumb_default_query_filter();
  f.category = r.bits(), f.mask = r.bits(), f.sensors = r.flag();
  f.ignore.index = r.bits(), f.ignore.generation = r.bits();
  return f;
}

plumb_spring spring(Reader& r) {
  const bool on = r.flag();
  const double hertz = r.number();
  return {on, hertz, r.number()};
}

plumb_joint_definition joint(Reader& r) {
  plumb_joint_definition d = plumb_default_joint(static_cast<plumb_joint_kind>(r.integer()));
  d.collide = r.flag(), d.break_force = r.number(), d.break_torque = r.number();
  d.user_data = r.wide();
  d.anchor_a = r.point(), d.anchor_b = r.point(), d.axis = r.point();
  d.reference_angle = r.number();
  d.spring = spring(r), d.linear_spring = spring(r), d.angular_spring = spring(r);
  d.limits.on = r.flag(), d.limits.lower = r.number(), d.limits.upper = r.number();
  d.motor.on = r.flag(), d.motor.speed = r.number(), d.motor.max_force = r.number();
  d.length = r.number(), d.target_angle = r.number(), d.target_translation = r.number();
  d.target_position = r.point();
  d.max_force = r.number(), d.max_torque = r.number(), d.ratio = r.number();
  d.phase = r.number(), d.tooth = r.number();
  d.ground_a = r.point(), d.ground_b = r.point();
  return d;
}

void write(Writer& w, const plumb_contact& c) {
  w.id(c.shape_a).id(c.shape_b).add(c.normal).add(c.count);
  for (int i = 0; i < 2; ++i) w.add(c.points[i]).add(c.separations[i]).add(c.impulses[i]);
  w.add(c.approach);
}

}  // namespace

#define PLUMB_EXPORT(name) __attribute__((export_name(name)))
#define PLUMB_IMPORT(name) __attribute__((import_module("plumb"), import_name(name)))

extern "C" {

/// Throws in JavaScript, and does not return.
PLUMB_IMPORT("fail")
void js_fail(int kind, const char* sentence, const char* subject, const char* field, const char* value);
/// Calls the hook of a world with the contact in the buffer.
PLUMB_IMPORT("pre_solve") int js_pre_solve(void* world);

void* __cxa_allocate_exception(std::size_t size) throw() { return std::malloc(size); }

// Debian's C++ runtime for WebAssembly cannot unwind: no `catch` runs, so nothing adds to the message on the
// way out.
[[noreturn]] void __cxa_throw(void* thrown, std::type_info* type, void (*)(void*)) {
  if (*type == typeid(plumb::Error)) {
    const auto& error = *static_cast<const plumb::Error*>(thrown);
    js_fail(static_cast<int>(error.kind()), error.what(), error.subject().c_str(), error.field().c_str(),
            error.value().c_str());
  } else {
    js_fail(-1, type->name(), "", "", "");
  }
  std::abort();
}

/// Returns the buffer, with room for `count` numbers.
PLUMB_EXPORT("numbers") double* js_numbers(std::size_t count) {
  numbers.resize(count);
  return numbers.data();
}
PLUMB_EXPORT("number_count") std::size_t js_number_count() { return numbers.size(); }
/// Returns room for `count` bytes.
PLUMB_EXPORT("bytes") unsigned char* js_bytes(std::size_t count) {
  bytes.resize(count);
  return bytes.data();
}

PLUMB_EXPORT("world_create") plumb_world* js_world_create() {
  Reader r;
  plumb_world_definition d = plumb_default_world();
  d.precision = static_cast<plumb_precision>(r.integer());
  d.gravity = r.point();
  d.combine_friction = static_cast<plumb_combine>(r.integer());
  d.combine_restitution = static_cast<plumb_combine>(r.integer());
  d.sleeping = r.flag(), d.continuous = r.flag();
  d.solver = static_cast<plumb_solver>(r.integer());
  d.integrator = static_cast<plumb_integrator>(r.integer());
  d.iterations = r.integer();
  d.direct_islands = r.flag(), d.quarantine = r.flag();
  return plumb_world_create(&d);
}
PLUMB_EXPORT("world_destroy") void js_world_destroy(plumb_world* w) { plumb_world_destroy(w); }
PLUMB_EXPORT("world_step") void js_world_step(plumb_world* w, double dt, int substeps, int count) {
  for (int i = 0; i < count; ++i) plumb_world_step(w, dt, substeps);
}
PLUMB_EXPORT("world_time") double js_world_time(plumb_world* w) { return plumb_world_time(w); }
PLUMB_EXPORT("world_hash") std::uint64_t js_world_hash(plumb_world* w) { return plumb_world_hash(w); }
PLUMB_EXPORT("world_full_hash") std::uint64_t js_world_full_hash(plumb_world* w) {
  return plumb_world_full_hash(w);
}
PLUMB_EXPORT("world_set_gravity") void js_set_gravity(plumb_world* w, double x, double y) {
  plumb_world_set_gravity(w, {x, y});
}
PLUMB_EXPORT("world_gravity") double* js_gravity(plumb_world* w) {
  return Writer().add(plumb_world_gravity(w)).done();
}
PLUMB_EXPORT("world_set_sleeping") void js_set_sleeping(plumb_world* w, int on) {
  plumb_world_set_sleeping(w, on != 0);
}
PLUMB_EXPORT("world_set_continuous") void js_set_continuous(plumb_world* w, int on) {
  plumb_world_set_continuous(w, on != 0);
}
PLUMB_EXPORT("world_set_solver") void js_set_solver(plumb_world* w, int solver) {
  plumb_world_set_solver(w, static_cast<plumb_solver>(solver));
}
PLUMB_EXPORT("world_set_profiling") void js_set_profiling(plumb_world* w, int on) {
  plumb_world_set_profiling(w, on != 0);
}
PLUMB_EXPORT("world_profile") double* js_profile(plumb_world* w) {
  const plumb_profile p = plumb_world_profile(w);
  return Writer()
      .add(p.broad_phase)
      .add(p.narrow_phase)
      .add(p.solver)
      .add(p.finalize)
      .add(p.continuous)
      .add(p.events)
      .add(p.sleep)
      .add(static_cast<double>(p.steps))
      .done();
}
PLUMB_EXPORT("world_counts") double* js_counts(plumb_world* w) {
  const plumb_counts c = plumb_world_counts(w);
  return Writer()
      .add(c.bodies)
      .add(c.awake)
      .add(c.shapes)
      .add(c.contacts)
      .add(c.touching)
      .add(c.joints)
      .done();
}

// Arrays of all bodies. Each has its own memory, which stays until the next call of the same function.
PLUMB_EXPORT("world_poses") const plumb_pose* js_poses(plumb_world* w) {
  static std::vector<plumb_pose> all;
  static_assert(sizeof(plumb_pose) == 3 * sizeof(double));
  all.resize(plumb_world_bodies(w, nullptr, 0));
  plumb_world_poses(w, all.data(), all.size());
  return all.data();
}
PLUMB_EXPORT("world_velocities") const plumb_velocity* js_velocities(plumb_world* w) {
  static std::vector<plumb_velocity> all;
  static_assert(sizeof(plumb_velocity) == 3 * sizeof(double));
  all.resize(plumb_world_bodies(w, nullptr, 0));
  plumb_world_velocities(w, all.data(), all.size());
  return all.data();
}
PLUMB_EXPORT("world_bodies") const plumb_body* js_bodies(plumb_world* w) {
  static std::vector<plumb_body> all;
  all.resize(plumb_world_bodies(w, nullptr, 0));
  plumb_world_bodies(w, all.data(), all.size());
  return all.data();
}
PLUMB_EXPORT("body_count") std::size_t js_body_count(plumb_world* w) {
  return plumb_world_bodies(w, nullptr, 0);
}

PLUMB_EXPORT("world_save") std::size_t js_save(plumb_world* w) {
  bytes.resize(plumb_world_save(w, nullptr, 0));
  return plumb_world_save(w, bytes.data(), bytes.size());
}
PLUMB_EXPORT("world_restore") void js_restore(plumb_world* w) {
  plumb_world_restore(w, bytes.data(), bytes.size());
}

PLUMB_EXPORT("world_contacts") double* js_contacts(plumb_world* w) {
  std::vector<plumb_contact> all(plumb_world_contacts(w, nullptr, 0));
  plumb_world_contacts(w, all.data(), all.size());
  Writer writer;
  for (const plumb_contact& contact : all) write(writer, contact);
  return writer.done();
}
/// Writes the lengths of the nine lists, and then the lists.
PLUMB_EXPORT("world_events") double* js_events(plumb_world* w) {
  const plumb_events e = plumb_world_events(w);
  Writer out;
  for (const std::size_t count :
       {e.begin_count, e.end_count, e.hit_count, e.sensor_begin_count, e.sensor_end_count, e.broken_count,
        e.fell_asleep_count, e.woke_count, e.quarantined_count})
    out.add(static_cast<double>(count));
  const auto touches = [&](const plumb_touch_event* all, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) out.id(all[i].shape_a).id(all[i].shape_b);
  };
  const auto sensed = [&](const plumb_sensor_event* all, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) out.id(all[i].sensor).id(all[i].visitor);
  };
  touches(e.begin, e.begin_count), touches(e.end, e.end_count);
  for (std::size_t i = 0; i < e.hit_count; ++i) {
    const plumb_hit_event& hit = e.hits[i];
    out.id(hit.shape_a).id(hit.shape_b).add(hit.point).add(hit.normal).add(hit.speed);
  }
  sensed(e.sensor_begin, e.sensor_begin_count), sensed(e.sensor_end, e.sensor_end_count);
  for (std::size_t i = 0; i < e.broken_count; ++i) out.id(e.broken[i]);
  for (std::size_t i = 0; i < e.fell_asleep_count; ++i) out.id(e.fell_asleep[i]);
  for (std::size_t i = 0; i < e.woke_count; ++i) out.id(e.woke[i]);
  for (std::size_t i = 0; i < e.quarantined_count; ++i) out.id(e.quarantined[i].body);
  return out.done();
}
PLUMB_EXPORT("world_on_pre_solve") void js_on_pre_solve(plumb_world* w, int on) {
  const auto call = [](const plumb_contact* contact, void* world) {
    Writer writer;
    write(writer, *contact);
    return js_pre_solve(world) != 0;
  };
  plumb_world_on_pre_solve(w, on != 0 ? +call : nullptr, w);
}

PLUMB_EXPORT("body_create") double* js_body_create(plumb_world* w) {
  Reader r;
  plumb_body_definition d = plumb_default_body();
  d.type = static_cast<plumb_body_type>(r.integer());
  d.position = r.point(), d.angle = r.number();
  d.velocity = r.point(), d.angular_velocity = r.number();
  d.mass_given = r.flag(), d.mass.mass = r.number(), d.mass.centre = r.point(), d.mass.inertia = r.number();
  d.gravity_scale = r.number(), d.linear_damping = r.number(), d.angular_damping = r.number();
  d.lock_x = r.flag(), d.lock_y = r.flag(), d.lock_rotation = r.flag();
  d.may_sleep = r.flag(), d.awake = r.flag();
  d.user_data = r.wide();
  bytes.push_back(0);
  d.name = reinterpret_cast<const char*>(bytes.data());
  std::vector<ShapeInput> inputs(r.bits());
  std::vector<plumb_shape_definition> shapes;
  for (ShapeInput& input : inputs) {
    read(r, input);
    shapes.push_back(input.definition);
  }
  return Writer().id(plumb_body_create(w, &d, shapes.data(), shapes.size())).done();
}

#define PLUMB_BODY_CALL(name, call, ...)                                                              \
  PLUMB_EXPORT("body_" #name)                                                                         \
  void js_body_##name(plumb_world* w, std::uint32_t index, std::uint32_t generation, ##__VA_ARGS__) { \
    const plumb_body body{index, generation};                                                         \
    call;                                                                                             \
  }
#define PLUMB_BODY_READ(name, Result, value)                                             \
  PLUMB_EXPORT("body_" #name)                                                            \
  Result js_body_##name(plumb_world* w, std::uint32_t index, std::uint32_t generation) { \
    const plumb_body body{index, generation};                                            \
    return value;                                                                        \
  }
PLUMB_BODY_CALL(destroy, plumb_body_destroy(w, body))
PLUMB_BODY_CALL(set_pose, plumb_body_set_pose(w, body, {{x, y}, angle}), double x, double y, double angle)
PLUMB_BODY_CALL(set_velocity, plumb_body_set_velocity(w, body, {x, y}), double x, double y)
PLUMB_BODY_CALL(set_angular_velocity, plumb_body_set_angular_velocity(w, body, value), double value)
PLUMB_BODY_CALL(move_towards, plumb_body_move_towards(w, body, {{x, y}, angle}, dt), double x, double y,
                double angle, double dt)
PLUMB_BODY_CALL(apply_force, plumb_body_apply_force(w, body, {x, y}), double x, double y)
PLUMB_BODY_CALL(apply_force_at, plumb_body_apply_force_at(w, body, {x, y}, {px, py}), double x, double y,
                double px, double py)
PLUMB_BODY_CALL(apply_torque, plumb_body_apply_torque(w, body, value), double value)
PLUMB_BODY_CALL(apply_impulse, plumb_body_apply_impulse(w, body, {x, y}), double x, double y)
PLUMB_BODY_CALL(apply_impulse_at, plumb_body_apply_impulse_at(w, body, {x, y}, {px, py}), double x, double y,
                double px, double py)
PLUMB_BODY_CALL(apply_angular_impulse, plumb_body_apply_angular_impulse(w, body, value), double value)
PLUMB_BODY_CALL(set_type, plumb_body_set_type(w, body, static_cast<plumb_body_type>(type)), int type)
PLUMB_BODY_CALL(set_mass, plumb_body_set_mass(w, body, {mass, {x, y}, inertia}), double mass, double x,
                double y, double inertia)
PLUMB_BODY_CALL(use_densities, plumb_body_use_densities(w, body))
PLUMB_BODY_CALL(set_gravity_scale, plumb_body_set_gravity_scale(w, body, value), double value)
PLUMB_BODY_CALL(set_damping, plumb_body_set_damping(w, body, linear, angular), double linear, double angular)
PLUMB_BODY_CALL(set_locks, plumb_body_set_locks(w, body, x != 0, y != 0, rotation != 0), int x, int y,
                int rotation)
PLUMB_BODY_CALL(set_awake, plumb_body_set_awake(w, body, on != 0), int on)
PLUMB_BODY_CALL(set_may_sleep, plumb_body_set_may_sleep(w, body, on != 0), int on)
PLUMB_BODY_CALL(release, plumb_body_release(w, body))
PLUMB_BODY_READ(valid, int, plumb_body_valid(w, body))
PLUMB_BODY_READ(position, double*, Writer().add(plumb_body_position(w, body)).done())
PLUMB_BODY_READ(centre, double*, Writer().add(plumb_body_centre(w, body)).done())
PLUMB_BODY_READ(angle, double, plumb_body_angle(w, body))
PLUMB_BODY_READ(velocity, double*, Writer().add(plumb_body_velocity(w, body)).done())
PLUMB_BODY_READ(angular_velocity, double, plumb_body_angular_velocity(w, body))
PLUMB_BODY_READ(type, int, plumb_body_get_type(w, body))
PLUMB_BODY_READ(mass, double, plumb_body_mass(w, body))
PLUMB_BODY_READ(inertia, double, plumb_body_inertia(w, body))
PLUMB_BODY_READ(gravity_scale, double, plumb_body_gravity_scale(w, body))
PLUMB_BODY_READ(linear_damping, double, plumb_body_linear_damping(w, body))
PLUMB_BODY_READ(angular_damping, double, plumb_body_angular_damping(w, body))
PLUMB_BODY_READ(awake, int, plumb_body_awake(w, body))
PLUMB_BODY_READ(user_data, std::uint64_t, plumb_body_user_data(w, body))
PLUMB_BODY_READ(name, const char*, plumb_body_name(w, body))
PLUMB_BODY_READ(quarantined, int, plumb_body_quarantined(w, body))
/// Returns the shapes of a body.
PLUMB_EXPORT("body_shapes")
double* js_body_shapes(plumb_world* w, std::uint32_t index, std::uint32_t generation) {
  const plumb_body body{index, generation};
  std::vector<plumb_shape> all(plumb_body_shapes(w, body, nullptr, 0));
  plumb_body_shapes(w, body, all.data(), all.size());
  Writer out;
  for (const plumb_shape shape : all) out.id(shape);
  return out.done();
}

PLUMB_EXPORT("shape_create")
double* js_shape_create(plumb_world* w, std::uint32_t index, std::uint32_t generation) {
  Reader r;
  ShapeInput input;
  read(r, input);
  return Writer().id(plumb_shape_create(w, {index, generation}, &input.definition)).done();
}
PLUMB_EXPORT("chain_create")
double* js_chain_create(plumb_world* w, std::uint32_t index, std::uint32_t generation) {
  Reader r;
  plumb_chain_definition d = plumb_default_chain();
  d.closed = r.flag();
  d.material = material(r), d.filter = filter(r);
  const std::vector<plumb_vec2> points = r.points();
  d.points = points.data(), d.point_count = points.size();
  return Writer().id(plumb_chain_create(w, {index, generation}, &d)).done();
}
#define PLUMB_SHAPE plumb_world *w, std::uint32_t index, std::uint32_t generation
PLUMB_EXPORT("shape_destroy") void js_shape_destroy(PLUMB_SHAPE) {
  plumb_shape_destroy(w, {index, generation});
}
PLUMB_EXPORT("shape_valid") int js_shape_valid(PLUMB_SHAPE) {
  return plumb_shape_valid(w, {index, generation});
}
PLUMB_EXPORT("shape_body") double* js_shape_body(PLUMB_SHAPE) {
  return Writer().id(plumb_shape_body(w, {index, generation})).done();
}
PLUMB_EXPORT("shape_user_data") std::uint64_t js_shape_user_data(PLUMB_SHAPE) {
  return plumb_shape_user_data(w, {index, generation});
}
PLUMB_EXPORT("shape_material") double* js_shape_material(PLUMB_SHAPE) {
  const plumb_material m = plumb_shape_material(w, {index, generation});
  return Writer().add(m.friction).add(m.restitution).add(m.rolling_resistance).add(m.surface_speed).done();
}
PLUMB_EXPORT("shape_set_material") void js_shape_set_material(PLUMB_SHAPE) {
  Reader r;
  plumb_shape_set_material(w, {index, generation}, material(r));
}
PLUMB_EXPORT("shape_set_filter") void js_shape_set_filter(PLUMB_SHAPE) {
  Reader r;
  plumb_shape_set_filter(w, {index, generation}, filter(r));
}
PLUMB_EXPORT("shape_overlapping") double* js_shape_overlapping(PLUMB_SHAPE) {
  std::vector<plumb_shape> all(plumb_shape_overlapping(w, {index, generation}, nullptr, 0));
  plumb_shape_overlapping(w, {index, generation}, all.data(), all.size());
  Writer out;
  for (const plumb_shape shape : all) out.id(shape);
  return out.done();
}
PLUMB_EXPORT("chain_destroy") void js_chain_destroy(PLUMB_SHAPE) {
  plumb_chain_destroy(w, {index, generation});
}

PLUMB_EXPORT("joint_create")
double* js_joint_create(plumb_world* w, std::uint32_t a, std::uint32_t a_generation, std::uint32_t b,
                        std::uint32_t b_generation) {
  Reader r;
  const plumb_joint_definition d = joint(r);
  return Writer().id(plumb_joint_create(w, {a, a_generation}, {b, b_generation}, &d)).done();
}
PLUMB_EXPORT("joint_destroy") void js_joint_destroy(PLUMB_SHAPE) {
  plumb_joint_destroy(w, {index, generation});
}
PLUMB_EXPORT("joint_valid") int js_joint_valid(PLUMB_SHAPE) {
  return plumb_joint_valid(w, {index, generation});
}
PLUMB_EXPORT("joint_change") void js_joint_change(PLUMB_SHAPE) {
  Reader r;
  const plumb_joint_definition d = joint(r);
  plumb_joint_change(w, {index, generation}, &d);
}
PLUMB_EXPORT("joint_read") double* js_joint_read(PLUMB_SHAPE) {
  const plumb_joint_reading r = plumb_joint_read(w, {index, generation});
  return Writer()
      .add(r.force)
      .add(r.torque)
      .add(r.linear_error)
      .add(r.angular_error)
      .add(r.angle)
      .add(r.translation)
      .add(r.length)
      .done();
}

// Queries. Nothing is written where nothing is found.
PLUMB_EXPORT("ray_cast") double* js_ray_cast(plumb_world* w) {
  Reader r;
  const plumb_vec2 origin = r.point(), translation = r.point();
  const plumb_query_filter f = query(r);
  plumb_ray_hit hit;
  Writer out;
  if (plumb_ray_cast_closest(w, origin, translation, &f, &hit))
    out.id(hit.shape).id(hit.body).add(hit.point).add(hit.normal).add(hit.fraction);
  return out.done();
}
PLUMB_EXPORT("cast_shape") double* js_cast_shape(plumb_world* w) {
  Reader r;
  std::vector<plumb_vec2> points;
  const plumb_geometry g = geometry(r, points);
  plumb_pose pose{r.point(), 0};
  pose.angle = r.number();
  const plumb_vec2 translation = r.point();
  const plumb_query_filter f = query(r);
  plumb_cast_hit hit;
  Writer out;
  if (plumb_cast_shape_closest(w, &g, pose, translation, &f, &hit))
    out.id(hit.shape).id(hit.body).add(hit.point).add(hit.normal).add(hit.fraction).add(hit.overlapped);
  return out.done();
}
PLUMB_EXPORT("overlap_shape") double* js_overlap_shape(plumb_world* w) {
  Reader r;
  std::vector<plumb_vec2> points;
  const plumb_geometry g = geometry(r, points);
  plumb_pose pose{r.point(), 0};
  pose.angle = r.number();
  const plumb_query_filter f = query(r);
  std::vector<plumb_shape> all(plumb_overlap_shape(w, &g, pose, &f, nullptr, 0));
  plumb_overlap_shape(w, &g, pose, &f, all.data(), all.size());
  Writer out;
  for (const plumb_shape shape : all) out.id(shape);
  return out.done();
}
PLUMB_EXPORT("shapes_at") double* js_shapes_at(plumb_world* w) {
  Reader r;
  const plumb_vec2 point = r.point();
  const plumb_query_filter f = query(r);
  std::vector<plumb_shape> all(plumb_shapes_at(w, point, &f, nullptr, 0));
  plumb_shapes_at(w, point, &f, all.data(), all.size());
  Writer out;
  for (const plumb_shape shape : all) out.id(shape);
  return out.done();
}
PLUMB_EXPORT("nearest") double* js_nearest(plumb_world* w) {
  Reader r;
  const plumb_vec2 point = r.point();
  const double most = r.number();
  const plumb_query_filter f = query(r);
  plumb_nearest_hit hit;
  Writer out;
  if (plumb_nearest(w, point, most, &f, &hit))
    out.id(hit.shape).id(hit.body).add(hit.point).add(hit.normal).add(hit.distance);
  return out.done();
}
PLUMB_EXPORT("move") double* js_move(plumb_world* w, int push) {
  Reader r;
  std::vector<plumb_vec2> points;
  const plumb_geometry capsule = geometry(r, points);
  const plumb_vec2 position = r.point(), velocity = r.point();
  const double dt = r.number();
  plumb_mover_options o = plumb_default_mover();
  o.up = r.point(), o.max_slope = r.number(), o.step_height = r.number(), o.skin = r.number();
  o.mass = r.number(), o.push_force = r.number();
  o.filter = query(r);
  plumb_mover_hit hits[64];
  const plumb_mover_result m = plumb_move(w, &capsule, position, velocity, dt, &o, hits, 64);
  if (push != 0) plumb_apply_pushes(w, hits, m.hit_count < 64 ? m.hit_count : 64);
  return Writer()
      .add(m.position)
      .add(m.velocity)
      .add(m.on_ground)
      .add(m.squeezed)
      .add(m.ground_normal)
      .id(m.ground)
      .add(m.ground_velocity)
      .done();
}
}
