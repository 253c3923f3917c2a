#include <memory>

#include "bindings/c/handle.h"
#include "engine/world/state/bodies.h"
#include "engine/world/state/lock.h"
#include "engine/world/state_hash.h"
#include "engine/world/world_data.h"

using namespace plumb::c;
using plumb::BasicWorld;
using plumb::Error;
using plumb::Vec2d;

namespace {

plumb::WorldDefinition definition_of(const plumb_world_definition& d) {
  plumb::WorldDefinition result;
  result.gravity = in(d.gravity);
  result.combine_friction = in<plumb::Combine>(d.combine_friction, 5, "world", "combine_friction");
  result.combine_restitution = in<plumb::Combine>(d.combine_restitution, 5, "world", "combine_restitution");
  result.sleeping = d.sleeping, result.continuous = d.continuous;
  result.solver = in<plumb::Solver>(d.solver, 5, "world", "solver");
  result.integrator = in<plumb::Integrator>(d.integrator, 3, "world", "integrator");
  result.iterations = d.iterations;
  result.direct_islands = d.direct_islands, result.quarantine = d.quarantine;
  result.thresholds = {d.thresholds.hit, d.thresholds.bounce, d.thresholds.sleep};
  result.threads = d.threads;
  return result;
}

/// Calls `visit(index, id)` for each body of the world, by index, and returns their number.
template <class Real, class Visit>
std::size_t for_each_body(const BasicWorld<Real>& world, Visit&& visit) {
  const plumb::WorldData<Real>& data = world.data();
  std::size_t count = 0;
  for (int body = 0; body < data.bodies.size(); ++body) {
    if (!data.bodies.used(body)) continue;
    visit(count++, plumb::BodyId{static_cast<std::uint32_t>(body), data.bodies.generation(body)});
  }
  return count;
}

template <class Type, class Value>
size_t fill_bodies(const plumb_world* world, Type* to, size_t capacity, Value&& value) {
  return read_or<size_t>(0, world, [&](const auto& w) {
    if (capacity > 0) require(to, "out");
    return for_each_body(w, [&](std::size_t place, plumb::BodyId body) {
      if (place < capacity) to[place] = value(w, body);
    });
  });
}

}  // namespace

plumb_world* plumb_world_create(const plumb_world_definition* definition) {
  return checked_or<plumb_world*>(nullptr, [&] {
    const plumb_world_definition d = definition != nullptr ? *definition : plumb_default_world();
    const plumb::WorldDefinition settings = definition_of(d);
    if (in<int>(d.precision, 2, "world", "precision") == PLUMB_FLOAT)
      return new plumb_world{.world = plumb::World(settings)};
    return new plumb_world{.world = plumb::DoubleWorld(settings)};
  });
}
void plumb_world_destroy(plumb_world* world) {
  if (world == nullptr) return;
  checked([&] {
    read(world, [](const auto& w) { plumb::require_unlocked(w.data()); });
    delete world;
  });
}

plumb_status plumb_world_step(plumb_world* world, double dt, int substeps) {
  return change_checked(world, [&](auto& w) { w.step(dt, substeps); });
}
double plumb_world_time(const plumb_world* world) {
  return read_or(0.0, world, [](const auto& w) { return w.time(); });
}
int64_t plumb_world_step_count(const plumb_world* world) {
  return read_or<int64_t>(0, world, [](const auto& w) { return w.step_count(); });
}
plumb_world_definition plumb_world_get_definition(const plumb_world* world) {
  return read_or(plumb_default_world(), world, []<class Real>(const BasicWorld<Real>& w) {
    plumb::WorldDefinition settings = w.data().settings;
    settings.threads = w.threads();
    return out(settings, sizeof(Real) == sizeof(float) ? PLUMB_FLOAT : PLUMB_DOUBLE);
  });
}
uint64_t plumb_world_hash(const plumb_world* world) {
  return read_or<uint64_t>(0, world, [](const auto& w) { return w.hash(); });
}
uint64_t plumb_world_full_hash(const plumb_world* world) {
  return read_or<uint64_t>(0, world, [](const auto& w) { return plumb::full_hash(w); });
}

plumb_status plumb_world_set_gravity(plumb_world* world, plumb_vec2 gravity) {
  return change_checked(world, [&](auto& w) { w.set_gravity(in(gravity)); });
}
plumb_vec2 plumb_world_gravity(const plumb_world* world) {
  return read_or(plumb_vec2{}, world, [](const auto& w) { return out(w.gravity()); });
}
plumb_status plumb_world_set_sleeping(plumb_world* world, bool on) {
  return change_checked(world, [&](auto& w) { w.set_sleeping(on); });
}
plumb_status plumb_world_set_continuous(plumb_world* world, bool on) {
  return change_checked(world, [&](auto& w) { w.set_continuous(on); });
}
plumb_status plumb_world_set_solver(plumb_world* world, plumb_solver solver) {
  return change_checked(world,
                        [&](auto& w) { w.set_solver(in<plumb::Solver>(solver, 5, "world", "solver")); });
}
plumb_status plumb_world_set_iterations(plumb_world* world, int iterations) {
  return change_checked(world, [&](auto& w) { w.set_iterations(iterations); });
}
plumb_status plumb_world_set_direct_islands(plumb_world* world, bool on) {
  return change_checked(world, [&](auto& w) { w.set_direct_islands(on); });
}
plumb_status plumb_world_set_quarantine(plumb_world* world, bool on) {
  return change_checked(world, [&](auto& w) { w.set_quarantine(on); });
}
plumb_status plumb_world_set_thresholds(plumb_world* world, plumb_thresholds t) {
  return change_checked(world, [&](auto& w) { w.set_thresholds({t.hit, t.bounce, t.sleep}); });
}
plumb_thresholds plumb_world_get_thresholds(const plumb_world* world) {
  return read_or(plumb_thresholds{}, world, [](const auto& w) {
    const plumb::Thresholds t = w.thresholds();
    return plumb_thresholds{t.hit, t.bounce, t.sleep};
  });
}
plumb_status plumb_world_combine_with(plumb_world* world, plumb_combine_function friction,
                                      plumb_combine_function restitution) {
  return change_checked(world, [&](auto& w) {
    if constexpr (requires { w.combine_with(friction, restitution); }) {
      w.combine_with(friction, restitution);
    } else {
      throw Error(Error::Kind::Unsupported, "world", "combine_with", "",
                  "a recorded world cannot have combine rules of its own: they are code");
    }
  });
}

plumb_status plumb_world_set_threads(plumb_world* world, int threads) {
  return checked([&] { edit(world, [&](auto& w) { w.set_threads(threads); }); });
}
plumb_status plumb_world_set_task_system(plumb_world* world, const plumb_task_system* tasks) {
  return checked([&] {
    plumb::TaskSystem own;
    if (tasks != nullptr) {
      own = {&require(tasks->start, "start"), &require(tasks->finish, "finish"), tasks->user};
    }
    edit(world, [&](auto& w) { w.set_task_system(own); });
  });
}

plumb_counts plumb_world_counts(const plumb_world* world) {
  return read_or(plumb_counts{}, world, [](const auto& w) {
    const plumb::WorldCounts c = w.counts();
    return plumb_counts{c.bodies, c.awake, c.shapes, c.contacts, c.touching, c.joints};
  });
}
plumb_status plumb_world_set_profiling(plumb_world* world, bool on) {
  return checked([&] { edit(world, [&](auto& w) { w.set_profiling(on); }); });
}
plumb_profile plumb_world_profile(const plumb_world* world) {
  return read_or(plumb_profile{}, world, [](const auto& w) {
    const plumb::WorldProfile& p = w.profile();
    using Stage = plumb::WorldStage;
    return plumb_profile{
        p.of(Stage::BroadPhase), p.of(Stage::NarrowPhase), p.of(Stage::Solver), p.of(Stage::Finalize),
        p.of(Stage::Continuous), p.of(Stage::Events),      p.of(Stage::Sleep),  p.steps};
  });
}

size_t plumb_world_bodies(const plumb_world* world, plumb_body* out_bodies, size_t capacity) {
  return fill_bodies(world, out_bodies, capacity, [](const auto&, plumb::BodyId body) { return out(body); });
}
size_t plumb_world_poses(const plumb_world* world, plumb_pose* out_poses, size_t capacity) {
  return fill_bodies(world, out_poses, capacity, [](const auto& w, plumb::BodyId body) {
    const int index = static_cast<int>(body.index);  // it is valid: no handle needs to be looked up
    return plumb_pose{out(plumb::origin_of(w.data(), index)), w.data().bodies[index].angle};
  });
}
size_t plumb_world_velocities(const plumb_world* world, plumb_velocity* out_velocities, size_t capacity) {
  return fill_bodies(world, out_velocities, capacity, [](const auto& w, plumb::BodyId body) {
    return plumb_velocity{out(w.velocity(body)), w.angular_velocity(body)};
  });
}

size_t plumb_world_states(const plumb_world* world, plumb_body_state* out_states, size_t capacity) {
  return fill_bodies(world, out_states, capacity,
                     [](const auto& w, plumb::BodyId body) { return out(w.state(body)); });
}

plumb_quarantine_event plumb::c::out(const plumb::QuarantineEvent& e) {
  return {out(e.body), plumb::kBadFieldNames[static_cast<int>(e.field)], e.value, e.step};
}
size_t plumb_world_quarantined(const plumb_world* world, plumb_quarantine_event* to, size_t capacity) {
  return read_or<size_t>(0, world, [&](const auto& w) { return fill(w.quarantined(), to, capacity); });
}
plumb_events plumb_world_events(plumb_world* world) {
  return read_or(plumb_events{}, world, [&](const auto& w) {
    const plumb::Events& from = w.events();
    plumb_event_arrays& to = world->events;
    const auto convert = [](const auto& all, auto& into, auto&& each) {
      into.clear();
      for (const auto& event : all) into.push_back(each(event));
    };
    const auto touch = [](const plumb::TouchEvent& e) {
      return plumb_touch_event{out(e.shape_a), out(e.shape_b)};
    };
    const auto sensor = [](const plumb::SensorEvent& e) {
      return plumb_sensor_event{out(e.sensor), out(e.visitor)};
    };
    const auto id = [](plumb::BodyId body) { return out(body); };
    convert(from.begin, to.begin, touch);
    convert(from.end, to.end, touch);
    convert(from.hits, to.hits, [](const plumb::HitEvent& e) {
      return plumb_hit_event{out(e.shape_a), out(e.shape_b), out(e.point), out(e.normal), e.speed, e.impulse};
    });
    convert(from.sensor_begin, to.sensor_begin, sensor);
    convert(from.sensor_end, to.sensor_end, sensor);
    convert(from.broken, to.broken, [](const plumb::JointEvent& e) { return out(e.joint); });
    convert(from.loaded, to.loaded, [](const plumb::JointLoadEvent& e) {
      return plumb_load_event{out(e.joint), e.force, e.torque};
    });
    convert(from.fell_asleep, to.fell_asleep, id);
    convert(from.woke, to.woke, id);
    convert(from.quarantined, to.quarantined, [](const plumb::QuarantineEvent& e) { return out(e); });
    return plumb_events{
        to.begin.data(),        to.end.data(),         to.hits.data(),        to.sensor_begin.data(),
        to.sensor_end.data(),   to.broken.data(),      to.fell_asleep.data(), to.woke.data(),
        to.quarantined.data(),  to.begin.size(),       to.end.size(),         to.hits.size(),
        to.sensor_begin.size(), to.sensor_end.size(),  to.broken.size(),      to.fell_asleep.size(),
        to.woke.size(),         to.quarantined.size(), to.loaded.data(),      to.loaded.size()};
  });
}

plumb_status plumb_world_on_pre_solve(plumb_world* world, plumb_pre_solve_function hook, void* context) {
  return change_checked(world, [&](auto& w) {
    if (hook == nullptr) return w.on_pre_solve({});
    w.on_pre_solve([hook, context](const plumb::ContactReading& reading) {
      const plumb_contact contact = out(reading);
      return hook(&contact, context);
    });
  });
}

plumb_status plumb_world_on_filter(plumb_world* world, plumb_filter_function filter, void* context) {
  return change_checked(world, [&](auto& w) {
    if constexpr (requires { w.on_filter({}); }) {
      if (filter == nullptr) return w.on_filter({});
      w.on_filter(
          [filter, context](plumb::ShapeId a, plumb::ShapeId b) { return filter(out(a), out(b), context); });
    } else {
      throw Error(Error::Kind::Unsupported, "world", "on_filter", "",
                  "a recorded world cannot have a filter of its own: it is code");
    }
  });
}

plumb_contact plumb::c::out(const plumb::ContactReading& r) {
  plumb_contact contact{};
  contact.shape_a = out(r.shape_a), contact.shape_b = out(r.shape_b);
  contact.normal = out(r.normal);
  contact.count = r.count;
  for (int i = 0; i < 2; ++i) {
    contact.points[i] = out(r.points[i]);
    contact.separations[i] = r.separations[i];
    contact.impulses[i] = r.impulses[i];
  }
  contact.approach = r.approach;
  contact.step_impulse = r.step_impulse;
  return contact;
}

size_t plumb_body_contacts(const plumb_world* world, plumb_body body, plumb_contact* to, size_t capacity) {
  return read_or<size_t>(0, world, [&](const auto& w) { return fill(w.contacts(in(body)), to, capacity); });
}
size_t plumb_world_contacts(const plumb_world* world, plumb_contact* to, size_t capacity) {
  return read_or<size_t>(0, world, [&](const auto& w) {
    std::vector<plumb::ContactReading> all(w.contacts(std::span<plumb::ContactReading>{}));
    w.contacts(all);
    return fill(all, to, capacity);
  });
}
bool plumb_shape_contact(const plumb_world* world, plumb_shape a, plumb_shape b, plumb_contact* to) {
  return read_or(false, world, [&](const auto& w) {
    const auto found = w.contact(in(a), in(b));
    if (found) require(to, "out") = out(*found);
    return found.has_value();
  });
}
size_t plumb_world_moved(const plumb_world* world, plumb_body* to, size_t capacity) {
  return read_or<size_t>(0, world, [&](const auto& w) {
    std::vector<plumb::BodyId> all(w.moved({}));
    w.moved(all);
    return fill(all, to, capacity);
  });
}
