#include "bindings/c/handle.h"
#include "bindings/javascript/buffer.h"
#include "engine/world/step/step.h"
#include "engine/world/world_data.h"

using namespace plumb::javascript;

namespace {

void write(Writer& w, const plumb_contact& c) {
  w.id(c.shape_a).id(c.shape_b).add(c.normal).add(c.count);
  for (int i = 0; i < 2; ++i) w.add(c.points[i]).add(c.separations[i]).add(c.impulses[i]);
  w.add(c.approach).add(c.step_impulse);
}

plumb_thresholds thresholds(Reader& r) {
  plumb_thresholds t{};
  t.hit = r.number(), t.bounce = r.number(), t.sleep = r.number();
  return t;
}

}  // namespace

extern "C" {

/// Calls the hook of a world with the contact in the buffer.
PLUMB_IMPORT("pre_solve") int js_pre_solve(void* world);
/// Calls the filter of a world with the shapes in the buffer.
PLUMB_IMPORT("filter") int js_filter(void* world);

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
  d.thresholds = thresholds(r);
  return plumb_world_create(&d);
}
PLUMB_EXPORT("world_destroy") void js_world_destroy(plumb_world* w) { plumb_world_destroy(w); }
PLUMB_EXPORT("world_step") void js_world_step(plumb_world* w, double dt, int substeps) {
  plumb_world_step(w, dt, substeps);
}
// Nothing unwinds the stack of a call that throws, so its locks stay. JavaScript notes them before calls that
// may lock the world, and puts them back after an error. It also locks worlds while it calls laws of its own.
PLUMB_EXPORT("world_locks") int js_locks(plumb_world* w) {
  return plumb::c::read(w, [](const auto& world) { return world.data().active_callbacks.load(); });
}
PLUMB_EXPORT("world_stepping") int js_stepping(plumb_world* w) {
  return plumb::c::read(w, [](const auto& world) { return world.data().stepping ? 1 : 0; });
}
PLUMB_EXPORT("world_set_locks") void js_set_locks(plumb_world* w, int locks, int stepping) {
  plumb::c::change(w, [&](auto& world) {
    auto& data = world.data();
    data.active_callbacks = locks;
    if (data.stepping && stepping == 0) plumb::end_interrupted_step(data);
  });
}
PLUMB_EXPORT("world_time") double js_world_time(plumb_world* w) { return plumb_world_time(w); }
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
PLUMB_EXPORT("world_set_iterations") void js_set_iterations(plumb_world* w, int iterations) {
  plumb_world_set_iterations(w, iterations);
}
PLUMB_EXPORT("world_set_direct_islands") void js_set_direct_islands(plumb_world* w, int on) {
  plumb_world_set_direct_islands(w, on != 0);
}
PLUMB_EXPORT("world_set_quarantine") void js_set_quarantine(plumb_world* w, int on) {
  plumb_world_set_quarantine(w, on != 0);
}
/// Writes the settings in the order in which `world_create` reads them.
PLUMB_EXPORT("world_definition") double* js_definition(plumb_world* w) {
  const plumb_world_definition d = plumb_world_get_definition(w);
  Writer out;
  out.add(d.precision).add(d.gravity).add(d.combine_friction).add(d.combine_restitution);
  out.add(d.sleeping).add(d.continuous).add(d.solver).add(d.integrator).add(d.iterations);
  out.add(d.direct_islands).add(d.quarantine);
  return out.add(d.thresholds.hit).add(d.thresholds.bounce).add(d.thresholds.sleep).done();
}
PLUMB_EXPORT("world_step_count") double js_step_count(plumb_world* w) {
  return static_cast<double>(plumb_world_step_count(w));
}
PLUMB_EXPORT("world_moved") double* js_moved(plumb_world* w) {
  return Writer()
      .ids(all_of<plumb_body>([&](auto* to, std::size_t n) { return plumb_world_moved(w, to, n); }))
      .done();
}
/// Writes body, address of the field's name, value and step of each fault.
PLUMB_EXPORT("world_quarantined") double* js_quarantined(plumb_world* w) {
  Writer out;
  for (const plumb_quarantine_event& e : all_of<plumb_quarantine_event>(
           [&](auto*to, std::size_t n) { return plumb_world_quarantined(w, to, n); })) {
    out.id(e.body).add(static_cast<double>(reinterpret_cast<std::uintptr_t>(e.field)));
    out.add(e.value).add(static_cast<double>(e.step));
  }
  return out.done();
}
PLUMB_EXPORT("world_set_thresholds") void js_set_thresholds(plumb_world* w) {
  Reader r;
  plumb_world_set_thresholds(w, thresholds(r));
}
PLUMB_EXPORT("world_thresholds") double* js_thresholds(plumb_world* w) {
  const plumb_thresholds t = plumb_world_get_thresholds(w);
  return Writer().add(t.hit).add(t.bounce).add(t.sleep).done();
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

PLUMB_EXPORT("body_contacts")
double* js_body_contacts(plumb_world* w, std::uint32_t index, std::uint32_t generation) {
  const plumb_body body{index, generation};
  Writer writer;
  for (const plumb_contact& contact :
       all_of<plumb_contact>([&](auto*to, std::size_t n) { return plumb_body_contacts(w, body, to, n); }))
    write(writer, contact);
  return writer.done();
}
/// Writes the contact of two shapes, and nothing for none.
PLUMB_EXPORT("shape_contact")
double* js_shape_contact(PLUMB_HANDLE, std::uint32_t other, std::uint32_t other_generation) {
  plumb_contact contact{};
  Writer writer;
  if (plumb_shape_contact(w, {index, generation}, {other, other_generation}, &contact))
    write(writer, contact);
  return writer.done();
}
PLUMB_EXPORT("world_contacts") double* js_contacts(plumb_world* w) {
  std::vector<plumb_contact> all(plumb_world_contacts(w, nullptr, 0));
  plumb_world_contacts(w, all.data(), all.size());
  Writer writer;
  for (const plumb_contact& contact : all) write(writer, contact);
  return writer.done();
}
/// Writes the lengths of the ten lists, and then the lists.
PLUMB_EXPORT("world_events") double* js_events(plumb_world* w) {
  const plumb_events e = plumb_world_events(w);
  Writer out;
  for (const std::size_t count :
       {e.begin_count, e.end_count, e.hit_count, e.sensor_begin_count, e.sensor_end_count, e.broken_count,
        e.fell_asleep_count, e.woke_count, e.quarantined_count, e.loaded_count})
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
    out.id(hit.shape_a).id(hit.shape_b).add(hit.point).add(hit.normal).add(hit.speed).add(hit.impulse);
  }
  sensed(e.sensor_begin, e.sensor_begin_count), sensed(e.sensor_end, e.sensor_end_count);
  for (std::size_t i = 0; i < e.broken_count; ++i) out.id(e.broken[i]);
  for (std::size_t i = 0; i < e.fell_asleep_count; ++i) out.id(e.fell_asleep[i]);
  for (std::size_t i = 0; i < e.woke_count; ++i) out.id(e.woke[i]);
  for (std::size_t i = 0; i < e.quarantined_count; ++i) out.id(e.quarantined[i].body);
  for (std::size_t i = 0; i < e.loaded_count; ++i)
    out.id(e.loaded[i].joint).add(e.loaded[i].force).add(e.loaded[i].torque);
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
PLUMB_EXPORT("world_on_filter") void js_on_filter(plumb_world* w, int on) {
  const auto call = [](plumb_shape a, plumb_shape b, void* world) {
    Writer().id(a).id(b);
    return js_filter(world) != 0;
  };
  plumb_world_on_filter(w, on != 0 ? +call : nullptr, w);
}
}
