#include "engine/world/recorder.h"

#include <utility>

#include "engine/scene/error.h"
#include "engine/world/recording/definition_members.h"
#include "engine/world/snapshot.h"
#include "engine/world/snapshot/body_hash.h"
#include "engine/world/snapshot/encoding.h"
#include "engine/world/state/lock.h"
#include "engine/world/state/validate.h"

namespace plumb {

template <class Real>
RecordedWorld<Real>::RecordedWorld(const std::filesystem::path& file, const WorldDefinition& definition,
                                   RecordOptions options)
    : world_(definition), options_(options), file_(file, sizeof(Real)) {
  Encoder(file_.begin(RecordKind::Definition)).put(definition);
  file_.commit();
  file_.flush();
}

template <class Real>
RecordedWorld<Real>::RecordedWorld(const std::filesystem::path& file, BasicWorld<Real>&& world,
                                   RecordOptions options)
    : world_(std::move(world)), options_(options), file_(file, sizeof(Real)) {
  record_state();
}

// Records a call after it succeeded: a rejected call changes nothing and is not recorded. A failing step is
// recorded, because steps are written before they are taken.
template <class Real>
template <WorldCall kCall, class... Arguments>
auto RecordedWorld<Real>::call(const Arguments&... arguments) {
  constexpr auto kMember = std::get<static_cast<std::size_t>(kCall)>(world_calls<Real>());
  Encoder record(file_.begin(RecordKind::Call));
  record.put(static_cast<std::uint8_t>(kCall));
  (record.put(arguments), ...);
  if constexpr (std::is_void_v<decltype((world_.*kMember)(arguments...))>) {
    (world_.*kMember)(arguments...);
    file_.commit();
  } else {
    const auto handle = (world_.*kMember)(arguments...);
    file_.commit();
    return handle;
  }
}

template <class Real>
void RecordedWorld<Real>::record_state() {
  const std::vector<std::byte> snapshot = save(world_);
  Encoder(file_.begin(RecordKind::State)).put(snapshot);
  file_.commit();
  file_.flush();
}

template <class Real>
void RecordedWorld<Real>::record_hash() {
  std::vector<BodyHash> bodies;
  if (options_.bodies) hash_awake_bodies(world_.data(), bodies);
  Encoder record(file_.begin(RecordKind::Hash));
  record.put(world_.hash());
  record.put(options_.bodies);
  if (options_.bodies) record.put(bodies);
  file_.commit();
  file_.flush();
}

template <class Real>
void RecordedWorld<Real>::step(double dt, int substeps) {
  // A step that is rejected at once is not recorded; one that fails later is.
  require_unlocked(world_.data());
  if (!(dt >= kSmallestNumber && dt <= kLargestNumber) || substeps < 1 || substeps > 1000)
    return world_.step(dt, substeps);
  Encoder record(file_.begin(RecordKind::Call));
  record.put(static_cast<std::uint8_t>(WorldCall::Step));
  record.put(dt), record.put(substeps);
  file_.commit();
  file_.flush();
  world_.step(dt, substeps);
  record_hash();
}

template <class Real>
void RecordedWorld<Real>::on_pre_solve(std::function<bool(const ContactReading&)> hook) {
  const bool there = static_cast<bool>(hook);
  world_.on_pre_solve(std::move(hook));
  Encoder(file_.begin(RecordKind::Hook)).put(there);
  file_.commit();
}

template <class Real>
void RecordedWorld<Real>::restore(std::span<const std::byte> snapshot) {
  plumb::restore(world_, snapshot);
  record_state();
}

template <class Real>
void RecordedWorld<Real>::edit(const std::function<void(BasicWorld<Real>&)>& change) {
  change(world_);
  record_state();
}

// ---- Calls

template <class Real>
void RecordedWorld<Real>::set_gravity(Vec2d gravity) {
  call<WorldCall::SetGravity>(gravity);
}
template <class Real>
void RecordedWorld<Real>::set_sleeping(bool on) {
  call<WorldCall::SetSleeping>(on);
}
template <class Real>
void RecordedWorld<Real>::set_continuous(bool on) {
  call<WorldCall::SetContinuous>(on);
}
template <class Real>
void RecordedWorld<Real>::set_solver(Solver solver) {
  call<WorldCall::SetSolver>(solver);
}
template <class Real>
void RecordedWorld<Real>::set_iterations(int iterations) {
  call<WorldCall::SetIterations>(iterations);
}
template <class Real>
void RecordedWorld<Real>::set_direct_islands(bool on) {
  call<WorldCall::SetDirectIslands>(on);
}
template <class Real>
void RecordedWorld<Real>::set_quarantine(bool on) {
  call<WorldCall::SetQuarantine>(on);
}
template <class Real>
void RecordedWorld<Real>::release(BodyId body) {
  call<WorldCall::Release>(body);
}

template <class Real>
BodyId RecordedWorld<Real>::create_body(const BodyDefinition& definition,
                                        std::span<const ShapeDefinition> shapes) {
  return call<WorldCall::CreateBody>(definition, shapes);
}
template <class Real>
BodyId RecordedWorld<Real>::create_body(const BodyDefinition& definition, const ShapeDefinition& shape) {
  return call<WorldCall::CreateBodyWithShape>(definition, shape);
}
template <class Real>
BodyId RecordedWorld<Real>::create_body(const BodyDefinition& definition,
                                        std::span<const ShapeDefinition> shapes, std::vector<ShapeId>& made) {
  const BodyId body = create_body(definition, shapes);
  made = world_.shapes(body);
  return body;
}
template <class Real>
void RecordedWorld<Real>::destroy(BodyId body) {
  call<WorldCall::DestroyBody>(body);
}
template <class Real>
void RecordedWorld<Real>::set_position(BodyId body, Vec2d position, double angle) {
  call<WorldCall::SetPosition>(body, position, angle);
}
template <class Real>
void RecordedWorld<Real>::set_velocity(BodyId body, Vec2d velocity) {
  call<WorldCall::SetVelocity>(body, velocity);
}
template <class Real>
void RecordedWorld<Real>::set_angular_velocity(BodyId body, double angular_velocity) {
  call<WorldCall::SetAngularVelocity>(body, angular_velocity);
}
template <class Real>
void RecordedWorld<Real>::move_towards(BodyId body, Vec2d position, double angle, double dt) {
  call<WorldCall::MoveTowards>(body, position, angle, dt);
}
template <class Real>
void RecordedWorld<Real>::apply_force(BodyId body, Vec2d force) {
  call<WorldCall::ApplyForce>(body, force);
}
template <class Real>
void RecordedWorld<Real>::apply_force(BodyId body, Vec2d force, Vec2d point) {
  call<WorldCall::ApplyForceAt>(body, force, point);
}
template <class Real>
void RecordedWorld<Real>::apply_torque(BodyId body, double torque) {
  call<WorldCall::ApplyTorque>(body, torque);
}
template <class Real>
void RecordedWorld<Real>::apply_impulse(BodyId body, Vec2d impulse) {
  call<WorldCall::ApplyImpulse>(body, impulse);
}
template <class Real>
void RecordedWorld<Real>::apply_impulse(BodyId body, Vec2d impulse, Vec2d point) {
  call<WorldCall::ApplyImpulseAt>(body, impulse, point);
}
template <class Real>
void RecordedWorld<Real>::apply_angular_impulse(BodyId body, double impulse) {
  call<WorldCall::ApplyAngularImpulse>(body, impulse);
}
template <class Real>
void RecordedWorld<Real>::set_type(BodyId body, BodyType type) {
  call<WorldCall::SetType>(body, type);
}
template <class Real>
void RecordedWorld<Real>::set_mass(BodyId body, const MassProperties& mass) {
  call<WorldCall::SetMass>(body, mass);
}
template <class Real>
void RecordedWorld<Real>::use_densities(BodyId body) {
  call<WorldCall::UseDensities>(body);
}
template <class Real>
void RecordedWorld<Real>::set_gravity_scale(BodyId body, double scale) {
  call<WorldCall::SetGravityScale>(body, scale);
}
template <class Real>
void RecordedWorld<Real>::set_damping(BodyId body, double linear, double angular) {
  call<WorldCall::SetDamping>(body, linear, angular);
}
template <class Real>
void RecordedWorld<Real>::set_locks(BodyId body, bool x, bool y, bool rotation) {
  call<WorldCall::SetLocks>(body, x, y, rotation);
}
template <class Real>
void RecordedWorld<Real>::set_awake(BodyId body, bool awake) {
  call<WorldCall::SetAwake>(body, awake);
}
template <class Real>
void RecordedWorld<Real>::set_may_sleep(BodyId body, bool may_sleep) {
  call<WorldCall::SetMaySleep>(body, may_sleep);
}

template <class Real>
ShapeId RecordedWorld<Real>::create_shape(BodyId body, const ShapeDefinition& definition) {
  return call<WorldCall::CreateShape>(body, definition);
}
template <class Real>
void RecordedWorld<Real>::destroy(ShapeId shape) {
  call<WorldCall::DestroyShape>(shape);
}
template <class Real>
void RecordedWorld<Real>::set_material(ShapeId shape, const Material& material) {
  call<WorldCall::SetMaterial>(shape, material);
}
template <class Real>
void RecordedWorld<Real>::set_user_data(BodyId body, std::uint64_t data) {
  call<WorldCall::SetBodyData>(body, data);
}
template <class Real>
void RecordedWorld<Real>::set_name(BodyId body, const std::string& name) {
  call<WorldCall::SetName>(body, name);
}
template <class Real>
void RecordedWorld<Real>::set_enabled(BodyId body, bool enabled) {
  call<WorldCall::SetEnabled>(body, enabled);
}
template <class Real>
void RecordedWorld<Real>::set_user_data(ShapeId shape, std::uint64_t data) {
  call<WorldCall::SetShapeData>(shape, data);
}
template <class Real>
void RecordedWorld<Real>::set_density(ShapeId shape, double density) {
  call<WorldCall::SetDensity>(shape, density);
}
template <class Real>
void RecordedWorld<Real>::set_sensor(ShapeId shape, bool sensor) {
  call<WorldCall::SetSensor>(shape, sensor);
}
template <class Real>
void RecordedWorld<Real>::set_hit_events(ShapeId shape, bool on) {
  call<WorldCall::SetHitEvents>(shape, on);
}
template <class Real>
void RecordedWorld<Real>::set_pre_solve(ShapeId shape, bool on) {
  call<WorldCall::SetShapePreSolve>(shape, on);
}
template <class Real>
void RecordedWorld<Real>::set_user_data(JointId joint, std::uint64_t data) {
  call<WorldCall::SetJointData>(joint, data);
}
template <class Real>
void RecordedWorld<Real>::set_continuous(BodyId body, bool on) {
  call<WorldCall::SetBodyContinuous>(body, on);
}
template <class Real>
void RecordedWorld<Real>::set_load_events(JointId joint, double force, double torque) {
  call<WorldCall::SetLoadEvents>(joint, force, torque);
}
template <class Real>
void RecordedWorld<Real>::set_thresholds(const Thresholds& thresholds) {
  call<WorldCall::SetThresholds>(thresholds);
}
template <class Real>
void RecordedWorld<Real>::set_filter(ShapeId shape, const Filter& filter) {
  call<WorldCall::SetFilter>(shape, filter);
}

template <class Real>
ChainId RecordedWorld<Real>::create_chain(BodyId body, const ChainDefinition& definition) {
  return call<WorldCall::CreateChain>(body, definition);
}
template <class Real>
void RecordedWorld<Real>::destroy(ChainId chain) {
  call<WorldCall::DestroyChain>(chain);
}

template <class Real>
JointId RecordedWorld<Real>::create_joint(BodyId a, BodyId b, const JointDefinition& definition) {
  return call<WorldCall::CreateJoint>(a, b, definition);
}
template <class Real>
void RecordedWorld<Real>::destroy(JointId joint) {
  call<WorldCall::DestroyJoint>(joint);
}
template <class Real>
void RecordedWorld<Real>::change(JointId joint, const JointKind& kind) {
  call<WorldCall::Change>(joint, kind);
}

template class RecordedWorld<float>;
template class RecordedWorld<double>;

}  // namespace plumb
