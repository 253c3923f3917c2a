#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <span>

#include "engine/world/recorded_calls.h"
#include "engine/world/recording_file.h"
#include "engine/world/world.h"

namespace plumb {

struct RecordOptions {
  /// After each step the hash of each body that is awake is written as well (8 bytes a body), so that a
  /// replay can say which bodies differ. Without it a step takes 40 bytes in all.
  bool bodies = true;
};

/// A world whose calls are written to a file, to be repeated later or elsewhere (replay.h). It is used like
/// the world itself: calls that change it are its own members, all others go through `->`.
///
/// A call is in the file, and with the operating system, before the step that it acts on is taken: a program
/// that crashes in a step, or is killed, leaves a recording that leads there. Calls that are refused are not
/// recorded. All members throw Error (Io) when the file cannot be written to any more.
template <class Real>
class RecordedWorld {
 public:
  /// A new world. Throws Error (Io) when the file cannot be written; what it held is lost.
  explicit RecordedWorld(const std::filesystem::path& file, const WorldDefinition& definition = {},
                         RecordOptions options = {});
  /// Goes on with a world that there is: its state comes first in the file.
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

  ShapeId create_shape(BodyId body, const ShapeDefinition& definition);
  void destroy(ShapeId shape);
  void set_material(ShapeId shape, const Material& material);
  void set_filter(ShapeId shape, const Filter& filter);

  ChainId create_chain(BodyId body, const ChainDefinition& definition);
  void destroy(ChainId chain);

  JointId create_joint(BodyId a, BodyId b, const JointDefinition& definition);
  void destroy(JointId joint);
  void change(JointId joint, const JointKind& kind);

  /// A hook is code and cannot be recorded: the replay has to be given the same one.
  void on_pre_solve(std::function<bool(const ContactReading&)> hook);

  /// The world becomes the one of a snapshot (snapshot.h).
  void restore(std::span<const std::byte> snapshot);

  /// For what has no call of its own here (force laws, a rollback): `change(world)` may do anything but step,
  /// and the state that it leaves is recorded as a whole.
  void edit(const std::function<void(BasicWorld<Real>&)>& change);

 private:
  template <WorldCall kCall, class... Arguments>
  auto call(const Arguments&... arguments);
  void record_state();
  void record_hash();

  BasicWorld<Real> world_;
  RecordOptions options_;
  RecordingWriter file_;
};

extern template class RecordedWorld<float>;
extern template class RecordedWorld<double>;

}  // namespace plumb
