#include "engine/simulation/simulation.h"

#include <algorithm>

#include "bindings/c/handle.h"
#include "engine/scene/json.h"
#include "engine/world/add_scene.h"
#include "engine/world/scene/scene_forces.h"

using namespace plumb::c;
using plumb::Error;

/// A compiled scene and the names of its bodies.
struct plumb_simulation {
  plumb::Simulation simulation;
  std::vector<std::string> names;
};

/// A scene in a world, and its force laws.
struct plumb_added_scene {
  plumb_world* world;
  plumb::SceneParts parts;
  std::variant<plumb::SceneForces<float>, plumb::SceneForces<double>> forces;
};

namespace {

plumb::Accuracy accuracy_of(const plumb_accuracy& a) {
  if (in<int>(a.method, 2, "accuracy", "method") == PLUMB_REALTIME) {
    plumb::Realtime r;
    r.dt = a.dt, r.substeps = a.substeps, r.iterations = a.iterations;
    r.precision = in<plumb::Precision>(a.precision, 2, "accuracy", "precision");
    r.integrator = in<plumb::Integrator>(a.integrator, 3, "accuracy", "integrator");
    r.solver = in<plumb::Solver>(a.solver, 5, "accuracy", "solver");
    r.continuous = a.continuous, r.sleeping = a.sleeping;
    r.on_violation = in<plumb::OnViolation>(a.on_violation, 3, "accuracy", "on_violation");
    return r;
  }
  plumb::Precise p;
  p.tolerance = a.tolerance, p.max_dt = a.dt;
  p.method = in<plumb::MotionMethod>(a.motion, 4, "accuracy", "motion");
  p.estimate_error = a.estimate_error;
  return p;
}

plumb_accuracy default_accuracy(plumb_method method) {
  const plumb::Realtime r;
  const plumb::Precise p;
  plumb_accuracy a{};
  a.method = method;
  a.dt = method == PLUMB_REALTIME ? r.dt : p.max_dt;
  a.substeps = r.substeps, a.iterations = r.iterations;
  a.precision = static_cast<plumb_precision>(r.precision);
  a.integrator = static_cast<plumb_integrator>(r.integrator);
  a.solver = static_cast<plumb_solver>(r.solver);
  a.continuous = r.continuous, a.sleeping = r.sleeping;
  a.on_violation = static_cast<plumb_on_violation>(r.on_violation);
  a.tolerance = p.tolerance;
  a.motion = static_cast<plumb_motion>(p.method);
  a.estimate_error = p.estimate_error;
  return a;
}

const plumb_simulation& opened(const plumb_simulation* simulation) {
  return require(simulation, "simulation");
}

std::size_t existing(const plumb_simulation& simulation, std::size_t body) {
  if (body < simulation.names.size()) return body;
  throw Error(Error::Kind::Name, "simulation", "body", std::to_string(body),
              "the scene has " + std::to_string(simulation.names.size()) + " bodies, from 0");
}

}  // namespace

size_t plumb_world_add_scene(plumb_world* world, const char* json, plumb_body* to, size_t capacity) {
  return checked_or<size_t>(0, [&] {
    const plumb::Scene scene = plumb::scene_from_json(&require(json, "json"));
    std::vector<plumb::BodyId> bodies;
    edit(world, [&](auto& w) { bodies = plumb::add_scene(w, scene).bodies; });
    return fill(bodies, to, capacity);
  });
}

plumb_status plumb_scene_world(const char* json, plumb_world_definition* definition) {
  return checked([&] {
    plumb_world_definition& to = require(definition, "definition");
    to = out(plumb::world_definition(plumb::scene_from_json(&require(json, "json"))), PLUMB_FLOAT);
  });
}
plumb_added_scene* plumb_scene_add(plumb_world* world, const char* json) {
  return checked_or<plumb_added_scene*>(nullptr, [&] {
    const plumb::Scene scene = plumb::scene_from_json(&require(json, "json"));
    std::unique_ptr<plumb_added_scene> added;
    edit(world, [&]<class Real>(plumb::BasicWorld<Real>& w) {
      plumb::SceneParts parts = plumb::add_scene(w, scene);
      plumb::SceneForces<Real> forces(scene, parts);
      added.reset(new plumb_added_scene{world, std::move(parts), std::move(forces)});
    });
    return added.release();
  });
}
void plumb_scene_destroy(plumb_added_scene* scene) { delete scene; }
size_t plumb_scene_bodies(const plumb_added_scene* scene, plumb_body* to, size_t capacity) {
  return checked_or<size_t>(0, [&] { return fill(require(scene, "scene").parts.bodies, to, capacity); });
}
size_t plumb_scene_joints(const plumb_added_scene* scene, plumb_joint* to, size_t capacity) {
  return checked_or<size_t>(0, [&] { return fill(require(scene, "scene").parts.joints, to, capacity); });
}
plumb_body plumb_scene_frame(const plumb_added_scene* scene) {
  return checked_or(kNoBody, [&] { return out(require(scene, "scene").parts.frame); });
}
plumb_status plumb_scene_apply_forces(plumb_added_scene* scene, double dt) {
  return checked([&] {
    plumb_added_scene& s = require(scene, "scene");
    edit(s.world, [&]<class Real>(plumb::BasicWorld<Real>& w) {
      std::get<plumb::SceneForces<Real>>(s.forces).apply(w, dt);
    });
  });
}

plumb_accuracy plumb_default_realtime(void) { return default_accuracy(PLUMB_REALTIME); }
plumb_accuracy plumb_default_precise(void) { return default_accuracy(PLUMB_PRECISE); }

plumb_simulation* plumb_simulation_create(const char* json, const plumb_accuracy* accuracy) {
  return checked_or<plumb_simulation*>(nullptr, [&] {
    const plumb::Scene scene = plumb::scene_from_json(&require(json, "json"));
    const plumb_accuracy a = accuracy != nullptr ? *accuracy : plumb_default_realtime();
    std::vector<std::string> names;
    for (const plumb::Body& body : scene.bodies) names.push_back(body.name);
    return new plumb_simulation{plumb::compile(scene, accuracy_of(a)), std::move(names)};
  });
}
void plumb_simulation_destroy(plumb_simulation* simulation) { delete simulation; }
plumb_status plumb_simulation_step(plumb_simulation* simulation, int count) {
  return checked([&] { require(simulation, "simulation").simulation.step(count); });
}
double plumb_simulation_time(const plumb_simulation* simulation) {
  return checked_or(0.0, [&] { return opened(simulation).simulation.time(); });
}
size_t plumb_simulation_body_count(const plumb_simulation* simulation) {
  return checked_or<size_t>(0, [&] { return opened(simulation).names.size(); });
}
int plumb_simulation_find(const plumb_simulation* simulation, const char* name) {
  return checked_or(-1, [&] {
    const auto& names = opened(simulation).names;
    const auto found = std::find(names.begin(), names.end(), &require(name, "name"));
    if (found != names.end()) return static_cast<int>(found - names.begin());
    throw Error(Error::Kind::Name, "simulation", "body", name, "the scene has no body of this name");
  });
}
plumb_body_state plumb_simulation_state(const plumb_simulation* simulation, size_t body) {
  return checked_or(plumb_body_state{}, [&] {
    const plumb_simulation& s = opened(simulation);
    return out(s.simulation.state(existing(s, body)));
  });
}
size_t plumb_simulation_states(const plumb_simulation* simulation, plumb_body_state* to, size_t capacity) {
  return checked_or<size_t>(0, [&] {
    const plumb_simulation& s = opened(simulation);
    std::vector<plumb::BodyState> states(s.names.size());
    s.simulation.read(states);
    if (!states.empty() && capacity > 0) require(to, "out");
    for (size_t i = 0; i < states.size() && i < capacity; ++i) to[i] = out(states[i]);
    return states.size();
  });
}
plumb_status plumb_simulation_set_state(plumb_simulation* simulation, size_t body, plumb_body_state state) {
  return checked([&] {
    plumb_simulation& s = require(simulation, "simulation");
    s.simulation.set_state(existing(s, body),
                           {in(state.position), state.angle, in(state.velocity), state.angular_velocity});
  });
}
uint64_t plumb_simulation_hash(const plumb_simulation* simulation) {
  return checked_or<uint64_t>(0, [&] { return opened(simulation).simulation.hash(); });
}
size_t plumb_simulation_save(const plumb_simulation* simulation, void* to, size_t capacity) {
  return checked_or<size_t>(0,
                            [&] { return fill_bytes(opened(simulation).simulation.save(), to, capacity); });
}
plumb_status plumb_simulation_restore(plumb_simulation* simulation, const void* bytes, size_t count) {
  return checked([&] {
    plumb_simulation& s = require(simulation, "simulation");
    require_countable("snapshot", "count", count);
    const auto* first = count > 0 ? &require(static_cast<const std::byte*>(bytes), "bytes") : nullptr;
    s.simulation.restore({first, count});
  });
}
plumb_statistics plumb_simulation_statistics(const plumb_simulation* simulation) {
  return checked_or(plumb_statistics{}, [&] {
    const plumb::Statistics s = opened(simulation).simulation.statistics();
    return plumb_statistics{s.steps,       s.rejected,       s.impacts,     s.evaluations,
                            s.error.known, s.error.position, s.error.angle, s.error.velocity};
  });
}
const char* plumb_simulation_violation(const plumb_simulation* simulation) {
  return checked_or<const char*>(nullptr, [&]() -> const char* {
    const Error* violation = opened(simulation).simulation.violation();
    return violation != nullptr ? violation->what() : nullptr;
  });
}
