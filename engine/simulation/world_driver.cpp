#include "engine/simulation/world_driver.h"

#include <algorithm>
#include <chrono>

#include "engine/driver/snapshot.h"
#include "engine/scene/error.h"
#include "engine/simulation/world_plan.h"
#include "engine/world/snapshot.h"
#include "engine/world/world_data.h"

namespace plumb {
namespace {

WorldDefinition definition_of(const Scene& scene, const Realtime& accuracy) {
  WorldDefinition definition = world_definition(scene);
  definition.sleeping = accuracy.sleeping;
  definition.continuous = accuracy.continuous;
  definition.solver = accuracy.solver;
  definition.integrator = accuracy.integrator;
  definition.iterations = accuracy.iterations;
  definition.threads = accuracy.threads;
  definition.quarantine = false;  // without one of its bodies, the run would be that of another scene
  return definition;
}

/// Adds the scene to the world, without shapes if it does not need them: masses do not depend on them.
template <class Real>
SceneParts add_planned(BasicWorld<Real>& world, const Scene& scene, const Plan& plan) {
  if (needs_shapes(plan)) return add_scene(world, scene);
  Scene shapeless = scene;
  for (Body& body : shapeless.bodies) {
    if (const double inertia = inertia_of(body); inertia > 0) body.inertia = inertia;
    body.shapes.clear();
  }
  return add_scene(world, shapeless);
}

}  // namespace

template <class Real>
WorldDriver<Real>::WorldDriver(const Scene& scene, const Realtime& accuracy, bool every_stage)
    : accuracy_(accuracy),
      plan_(plan_world(scene, accuracy, every_stage)),
      world_(definition_of(scene, accuracy)),
      parts_(add_planned(world_, scene, plan_)),
      forces_(scene, parts_),
      drives_(scene, parts_),
      start_states_(scene.bodies.size()) {
  if (accuracy_.on_violation != OnViolation::Ignore || every_stage) monitor_.emplace(world_);
}

template <class Real>
void WorldDriver<Real>::step() {
  read(start_states_);
  if (accuracy_.on_violation == OnViolation::Stop) plumb::save(world_, undo_snapshot_);
  try {
    advance();
  } catch (const Error& error) {
    restore_start_states();
    throw Error(Error::Kind::Run, error.subject(), error.field(), error.value(), error.problem());
  }
  ++steps_;
  if (profiling_) update_profile();
  if (step_violation_) handle_violation();
}

/// Advances the world by one step. Force laws are evaluated at the middle of each substep. So with force
/// laws, prescribed motions or drives, each substep is a step of the world. The Euler schemes evaluate forces
/// at the start.
template <class Real>
void WorldDriver<Real>::advance() {
  const bool one_by_one = !forces_.empty() || !drives_.empty();
  const int count = one_by_one ? accuracy_.substeps : 1;
  const double dt = accuracy_.dt / count;
  for (int i = 0; i < count; ++i) {
    if (one_by_one) drives_.apply(world_, dt);
    if (one_by_one) apply_forces(dt);
    if (monitor_) monitor_->begin_step();
    world_.step(dt, one_by_one ? 1 : accuracy_.substeps);
    if (monitor_) check();
  }
}

template <class Real>
void WorldDriver<Real>::apply_forces(double dt) {
  const auto start = std::chrono::steady_clock::now();
  if (accuracy_.integrator == Integrator::VelocityVerlet) {
    forces_.apply(world_, dt);
  } else {
    forces_.apply_at_start(world_, dt);
  }
  if (profiling_)
    force_time_ += std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - start).count();
}

template <class Real>
void WorldDriver<Real>::check() {
  std::optional<Error> error = monitor_->end_step();
  if (accuracy_.on_violation != OnViolation::Ignore && error && !step_violation_)
    step_violation_ = std::move(error);
}

template <class Real>
void WorldDriver<Real>::handle_violation() {
  const Error found = *step_violation_;
  step_violation_.reset();
  if (accuracy_.on_violation == OnViolation::Report) {
    if (!violation_) violation_ = found;
    return;
  }
  plumb::restore(world_, undo_snapshot_);
  --steps_;
  throw Error(found.kind(), found.subject(), found.field(), found.value(),
              found.problem() + ", after step " + std::to_string(steps_ + 1));
}

template <class Real>
void WorldDriver<Real>::read(std::span<BodyState> out) const {
  if (abandoned_) {
    std::ranges::copy(start_states_, out.begin());
    return;
  }
  // Dynamic bodies of a scene have their origin at the centre of mass; other bodies' shapes may lie anywhere.
  const WorldData<Real>& w = world_.data();
  for (std::size_t i = 0; i < parts_.bodies.size(); ++i) {
    const int body = static_cast<int>(parts_.bodies[i].index);
    const SolverBody<Real>& motion = w.motion[body];
    out[i] = {world_.position(parts_.bodies[i]), w.bodies[body].angle, motion.velocity.template as<double>(),
              static_cast<double>(motion.angular_velocity)};
  }
  drives_.read_velocities(time(), out);
}

template <class Real>
void WorldDriver<Real>::write(std::size_t body, const BodyState& state) {
  const BodyId id = parts_.bodies[body];
  world_.set_position(id, state.position, state.angle);
  if (world_.type(id) != BodyType::Static) {
    world_.set_velocity(id, state.velocity);
    world_.set_angular_velocity(id, state.angular_velocity);
  }
  violation_.reset();
  if (monitor_) monitor_->reset();
}

/// Sets all bodies back to the start of a step that failed, and drops its forces.
template <class Real>
void WorldDriver<Real>::restore_start_states() {
  WorldData<Real>& w = world_.data();
  if (w.loads.used()) std::fill_n(w.loads.data(), w.bodies.size(), Load<Real>{});
  for (std::size_t body = 0; body < start_states_.size(); ++body) write(body, start_states_[body]);
}

template <class Real>
std::vector<std::byte> WorldDriver<Real>::save() const {
  SnapshotWriter out;
  out.put(steps_);
  std::vector<std::byte> bytes = out.bytes();
  const std::vector<std::byte> world = plumb::save(world_);
  bytes.insert(bytes.end(), world.begin(), world.end());
  return bytes;
}

template <class Real>
void WorldDriver<Real>::restore(std::span<const std::byte> snapshot) {
  SnapshotReader in(snapshot);
  const auto steps = in.get<std::int64_t>();
  plumb::restore(world_, in.rest());
  steps_ = steps;
  violation_.reset();
  if (monitor_) monitor_->reset();
}

template <class Real>
void WorldDriver<Real>::profile(bool on) {
  profiling_ = on;
  force_time_ = 0;
  world_.set_profiling(on);
  for (Stage& stage : plan_.stages) stage.nanoseconds = 0;
}

template <class Real>
void WorldDriver<Real>::update_profile() {
  plan_.stages[kForcesStage].nanoseconds = force_time_;
  for (std::size_t i = 0; i < kWorldStages; ++i) {
    Stage& stage = plan_.stages[kFirstWorldStage + i];
    if (stage.active) stage.nanoseconds = world_.profile().nanoseconds[i];
  }
}

template <class Real>
Statistics WorldDriver<Real>::statistics() const {
  Statistics out;
  out.steps = steps_ * accuracy_.substeps;
  return out;
}

template class WorldDriver<float>;
template class WorldDriver<double>;

std::string realtime_unsupported(const Scene& scene, const Realtime& accuracy) {
  if (const std::string reason = world_unsupported(scene); !reason.empty()) return reason;
  try {
    accuracy.precision == Precision::Float ? require_in_range<float>(scene) : require_in_range<double>(scene);
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

}  // namespace plumb
