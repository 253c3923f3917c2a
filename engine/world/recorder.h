#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <span>

#include "engine/world/recording/recorded_calls.h"
#include "engine/world/recording/recording_file.h"
#include "engine/world/world.h"

namespace plumb {

struct RecordOptions {
  /// Writes the hash of each awake body after each step (8 bytes per body), so that a replay can report which
  /// bodies differ. Without it a step takes 40 bytes in all.
  bool bodies = true;
};

/// A world whose calls are written to a file, for a replay (replay.h). It is used like the world itself:
/// calls that change the world are members of this class, all others go through `->`.
/// Calls are written, and flushed to the operating system, before the step that they affect is made. If a
/// program crashes in a step, or is killed, its recording leads up to that step. Rejected calls are not
/// recorded. All members throw Error (Io) if the file can no longer be written.
template <class Real>
class RecordedWorld {
 public:
  /// Creates a new world. Throws Error (Io) if the file cannot be written; its previous contents are lost.
  explicit RecordedWorld(const std::filesystem::path& file, const WorldDefinition& definition = {},
                         RecordOptions options = {});
  /// Continues with an existing world, whose state is written first.
  RecordedWorld(const std::filesystem::path& file, BasicWorld<Real>&& world, RecordOptions options = {});

  const BasicWorld<Real>& operator*() const { return world_; }
  const BasicWorld<Real>* operator->() const { return &world_; }

  void step(double dt = 1.0 / 60, int substeps = 4);

  void set_gravity(Vec2d gravity);
  void set_sleeping(bool on);
  void set_continuous(bool on);
  void set_solver(Solver solver);
  void set_iterations(int iterations);
  void set_direct_islands(bool on);
  void set_quarantine(bool on);
  void set_thresholds(const Thresholds& thresholds);
  void release(BodyId body);

  BodyId create_body(const BodyDefinition& definition, std::span<const ShapeDefinition> shapes = {});
  BodyId create_body(const BodyDefinition& definition, const ShapeDefinition& shape);
  BodyId create_body(const BodyDefinition& definition, std::span<const ShapeDefinition> shapes,
                     std::vector<ShapeId>& made);
  void destroy(BodyId body);
  void set_position(BodyId body, Vec2d position, double angle);
  void set_velocity(BodyId body, Vec2d velocity);
  void set_angular_velocity(BodyId body, double angular_velocity);
  void move_towards(BodyId body, Vec2d position, double angle, double dt);
  void apply_force(BodyId body, Vec2d force);
  void apply_force(BodyId body, Vec2d force, Vec2d point);
  void apply_torque(BodyId body, double torque);
  void apply_impulse(BodyId body, Vec2d impulse);
  void apply_impulse(BodyId body, Vec2d impulse, Vec2d point);
  void apply_angular_impulse(BodyId body, double impulse);
  void set_type(BodyId body, BodyType type);
  void set_mass(BodyId body, const MassProperties& mass);
  void use_densities(BodyId body);
  void set_gravity_scale(BodyId body, double scale);
  void set_damping(BodyId body, double linear, double angular);
  void set_locks(BodyId body, bool x, bool y, bool rotation);
  void set_awake(BodyId body, bool awake);
  void set_may_sleep(BodyId body, bool may_sleep);
  void set_user_data(BodyId body, std::uint64_t data);
  void set_name(BodyId body, const std::string& name);
  void set_enabled(BodyId body, bool enabled);
  void set_continuous(BodyId body, bool on);

  ShapeId create_shape(BodyId body, const ShapeDefinition& definition);
  void destroy(ShapeId shape);
  void set_material(ShapeId shape, const Material& material);
  void set_geometry(ShapeId shape, const ShapeGeometry& geometry, Vec2d position = {}, double angle = 0);
  void set_filter(ShapeId shape, const Filter& filter);
  void set_user_data(ShapeId shape, std::uint64_t data);
  void set_density(ShapeId shape, double density);
  void set_sensor(ShapeId shape, bool sensor);
  void set_hit_events(ShapeId shape, bool on);
  void set_pre_solve(ShapeId shape, bool on);

  ChainId create_chain(BodyId body, const ChainDefinition& definition);
  void destroy(ChainId chain);

  JointId create_joint(BodyId a, BodyId b, const JointDefinition& definition);
  void destroy(JointId joint);
  void change(JointId joint, const JointKind& kind);
  void set_user_data(JointId joint, std::uint64_t data);
  void set_load_events(JointId joint, double force, double torque);

  /// Sets the hook. It is code and cannot be recorded: set the same hook for the replay.
  void on_pre_solve(std::function<bool(const ContactReading&)> hook);

  /// Restores the world from a snapshot (snapshot.h).
  void restore(std::span<const std::byte> snapshot);

  /// Makes changes that have no call here (force laws, a rollback). `change(world)` may do anything but step;
  /// the resulting state is recorded as a whole.
  void edit(const std::function<void(BasicWorld<Real>&)>& change);

 private:
  template <WorldCall kCall, class... Arguments>
  auto call(const Arguments&... arguments);
  void record_step(double dt, int substeps);
  void record_state();
  void record_hash();

  BasicWorld<Real> world_;
  RecordOptions options_;
  RecordingWriter file_;
};

extern template class RecordedWorld<float>;
extern template class RecordedWorld<double>;

}  // namespace plumb
