#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "engine/core/owned_pointer.h"
#include "engine/core/task_system.h"
#include "engine/geometry/aabb.h"
#include "engine/joints/joint_stiffness.h"
#include "engine/scene/error.h"
#include "engine/world/definitions.h"
#include "engine/world/events.h"
#include "engine/world/handles.h"
#include "engine/world/profile.h"

namespace plumb {

template <class Real>
struct WorldData;

/// Measurements of a joint.
struct JointReading {
  double force = 0, torque = 0;                ///< N, N m: mean reaction over the last step
  double linear_error = 0, angular_error = 0;  ///< m, rad: position error of the rigid rows
  double angle = 0;                            ///< rad, of b relative to a, from the reference angle
  double translation = 0;                      ///< m, along the axis (prismatic, wheel)
  double length = 0;                           ///< m (distance, pulley)
};

/// Two touching shapes, for the pre-solve hook and `contacts_of`.
struct ContactReading {
  ShapeId shape_a{}, shape_b{};
  Vec2d normal{};  ///< from a to b
  int count = 0;
  Vec2d points[2] = {};        ///< m
  double separations[2] = {};  ///< m, negative: overlap
  double impulses[2] = {};     ///< N s, along the normal, of the last substep
  double approach = 0;         ///< m/s, along the normal at the start of the step, negative: closing
  double step_impulse = 0;     ///< N s, along the normal, of the whole step and both points; 0 unless a shape
                               ///< has `hit_events` or `pre_solve`. Divided by dt it is the mean force
};

/// Pose of a body.
struct BodyPose {
  Vec2d position{};  ///< m, of its origin
  double angle = 0;  ///< rad, whole turns counted
};

struct WorldCounts {
  int bodies = 0, awake = 0, shapes = 0, contacts = 0, touching = 0, joints = 0;
};

/// A game's world: bodies, shapes and joints that are added, changed and removed while it advances in steps.
/// Positions are stored in double, everything else in `Real`; the interface uses double. SI units, y up,
/// angles in rad, counter-clockwise. Functions throw Error (Name) for handles of destroyed objects and Error
/// (Value) for numbers out of range, and then change nothing. A world is movable, not copyable: a moved-from
/// world throws Error (Name) at each call.
/// Calls wake all bodies that they could affect. User code that the world calls (hooks, rules, force laws,
/// visitors of queries) may read it; calls that change it throw Error (Unsupported). An exception thrown by
/// such code ends the call; the world remains usable. The same holds if memory runs out: calls that create
/// objects change nothing, others may be incomplete.
template <class Real>
class BasicWorld {
 public:
  explicit BasicWorld(const WorldDefinition& definition = {});
  ~BasicWorld();
  BasicWorld(BasicWorld&&) noexcept;
  BasicWorld& operator=(BasicWorld&&);

  /// Advances by `dt` s in `substeps` substeps; more substeps hold stacks and joints better. Quarantines
  /// bodies whose state would become non-finite or exceed 1e12.
  void step(double dt = 1.0 / 60, int substeps = 4);
  double time() const;  ///< s
  std::int64_t step_count() const;
  const Events& events() const;  ///< of the last step

  /// Sets the user's own combine rules for contacts that begin from now on; with null, those of the
  /// definition apply. Rules are code and not part of snapshots: set them again in a restored world. Recorded
  /// worlds cannot have them.
  void combine_with(CombineFunction friction, CombineFunction restitution);

  void set_gravity(Vec2d gravity);
  Vec2d gravity() const;
  void set_sleeping(bool on);
  void set_continuous(bool on);
  /// Takes effect in the next step; keeps accumulated impulses.
  void set_solver(Solver solver);
  Solver solver() const;
  void set_iterations(int iterations);  ///< per substep: SequentialImpulses and Jakobsen
  int iterations() const;
  void set_direct_islands(bool on);  ///< SoftSteps solves small islands directly
  /// Switches quarantine of bodies with a non-finite state on or off. Without it, Error (Run, or Value for a
  /// force law) ends the call; the step is then incomplete.
  void set_quarantine(bool on);
  /// Sets the speeds, m/s, at which behaviour changes; wakes all bodies if one differs. Throws Error (Value)
  /// for a number that is not finite.
  void set_thresholds(const Thresholds& thresholds);
  Thresholds thresholds() const;
  WorldCounts counts() const;
  /// Switches the stages' clocks on, from zero, or off. Not part of snapshots.
  void set_profiling(bool on);
  const WorldProfile& profile() const;  ///< all 0 until profiling is switched on
  /// Sets the number of threads that share a step, see WorldDefinition::threads. Throws Error (Value) for a
  /// number out of range, and Error (Run) if the system has no more threads; nothing is changed then.
  void set_threads(int threads);
  int threads() const;
  /// Shares steps with a game's own threads instead of a pool's: `threads() - 1` tasks at a time; see
  /// task_system.h. An empty task system restores the pool. Throws Error (Value) if one of its functions is
  /// missing. Not part of snapshots.
  void set_task_system(const TaskSystem& tasks);

  /// Returns the quarantined bodies and their faults, oldest first. They stay at their previous pose, without
  /// contacts and active joints, and queries skip them. They can be changed like any other body.
  std::vector<QuarantineEvent> quarantined() const;
  bool quarantined(BodyId body) const;
  /// Releases a body from quarantine, with its previous state or the one set since then.
  void release(BodyId body);

  // Bodies.
  BodyId create_body(const BodyDefinition& definition, std::span<const ShapeDefinition> shapes = {});
  BodyId create_body(const BodyDefinition& definition, const ShapeDefinition& shape);
  /// Does the same; `made` receives the handles of the shapes, in the order of their definitions.
  BodyId create_body(const BodyDefinition& definition, std::span<const ShapeDefinition> shapes,
                     std::vector<ShapeId>& made);
  void destroy(BodyId body);  ///< with its shapes, contacts and joints
  bool valid(BodyId body) const;
  std::vector<BodyId> bodies() const;  ///< all, by index

  /// Each of these fills `out` as far as there is space, and returns the total number. Poses and states are
  /// in the order of `bodies`; contacts (those with points) are in the order of their creation, each once.
  std::size_t bodies(std::span<BodyId> out) const;
  std::size_t poses(std::span<BodyPose> out) const;
  std::size_t states(std::span<BodyState> out) const;
  std::size_t contacts(std::span<ContactReading> out) const;
  std::size_t contacts(BodyId body, std::span<ContactReading> out) const;
  /// Fills in the bodies whose pose the last step may have changed: the awake ones, and those that it put to
  /// sleep. Not sorted, but in the same order on every platform.
  std::size_t moved(std::span<BodyId> out) const;

  Vec2d position(BodyId body) const;  ///< m, of the body's origin
  Vec2d centre(BodyId body) const;    ///< m, of the centre of mass; of a kinematic body, of its origin
  double angle(BodyId body) const;    ///< rad, whole turns counted
  Vec2d velocity(BodyId body) const;  ///< m/s, of its `centre`: a kinematic body turns about its origin
  double angular_velocity(BodyId body) const;
  Vec2d velocity_at(BodyId body, Vec2d point) const;  ///< m/s, of the body at a point of the world
  Vec2d world_point(BodyId body, Vec2d local) const;
  Vec2d local_point(BodyId body, Vec2d world) const;
  BodyState state(BodyId body) const;  ///< of the centre of mass

  void set_position(BodyId body, Vec2d position, double angle);
  void set_velocity(BodyId body, Vec2d velocity);
  void set_angular_velocity(BodyId body, double angular_velocity);
  /// Sets the velocities of a kinematic or dynamic body such that it reaches the pose after `dt`, if nothing
  /// stops it.
  void move_towards(BodyId body, Vec2d position, double angle, double dt);

  void apply_force(BodyId body, Vec2d force);  ///< N, at the centre of mass, during the next step
  void apply_force(BodyId body, Vec2d force, Vec2d point);
  void apply_torque(BodyId body, double torque);
  void apply_impulse(BodyId body, Vec2d impulse);  ///< N s, at once
  void apply_impulse(BodyId body, Vec2d impulse, Vec2d point);
  void apply_angular_impulse(BodyId body, double impulse);

  BodyType type(BodyId body) const;
  void set_type(BodyId body, BodyType type);
  double mass(BodyId body) const;     ///< kg, 0 unless dynamic
  double inertia(BodyId body) const;  ///< kg m^2 about the centre of mass
  void set_mass(BodyId body, const MassProperties& mass);
  void use_densities(BodyId body);  ///< computes mass from the shapes again
  void set_gravity_scale(BodyId body, double scale);
  void set_damping(BodyId body, double linear, double angular);
  void set_locks(BodyId body, bool x, bool y, bool rotation);
  void set_continuous(BodyId body, bool on);  ///< see BodyDefinition::continuous
  bool continuous(BodyId body) const;
  bool awake(BodyId body) const;
  void set_awake(BodyId body, bool awake);  ///< with its whole island
  void set_may_sleep(BodyId body, bool may_sleep);
  bool may_sleep(BodyId body) const;
  double gravity_scale(BodyId body) const;
  double linear_damping(BodyId body) const;   ///< 1/s
  double angular_damping(BodyId body) const;  ///< 1/s
  BodyLocks locks(BodyId body) const;
  std::uint64_t user_data(BodyId body) const;
  void set_user_data(BodyId body, std::uint64_t data);
  const std::string& name(BodyId body) const;
  void set_name(BodyId body, const std::string& name);
  /// Removes a body from the simulation, or restores it with its pose and velocity. Disabled bodies have no
  /// contacts and no active joints, and queries skip them; they can be changed like any other body. Does not
  /// release a body from quarantine.
  void set_enabled(BodyId body, bool enabled);
  bool enabled(BodyId body) const;  ///< false: disabled, or in quarantine
  /// Returns the smallest box around the body's shapes, m, rounded to `Real`. Without shapes it is at the
  /// body's origin.
  Aabb<double> box(BodyId body) const;
  std::vector<ShapeId> shapes(BodyId body) const;           ///< in the order of creation
  std::vector<JointId> joints(BodyId body) const;           ///< in the order of creation
  std::vector<ContactReading> contacts(BodyId body) const;  ///< contacts with points
  /// Returns the contact of two shapes; nothing unless it has points. After a begin event, normal and
  /// separations are those at the beginning of the step that made it, and impulses those of that step. Has
  /// nothing for a bounce whose shapes are apart after the step: see hit events. Takes time in proportion to
  /// the contacts of the body that has fewer.
  std::optional<ContactReading> contact(ShapeId a, ShapeId b) const;

  // Shapes.
  ShapeId create_shape(BodyId body, const ShapeDefinition& definition);
  void destroy(ShapeId shape);
  bool valid(ShapeId shape) const;
  BodyId body(ShapeId shape) const;
  std::uint64_t user_data(ShapeId shape) const;
  void set_user_data(ShapeId shape, std::uint64_t data);
  ChainId chain(ShapeId shape) const;     ///< of a segment; invalid for other shapes
  Aabb<double> box(ShapeId shape) const;  ///< m, after the last step or call; rounded to `Real`
  Material material(ShapeId shape) const;
  void set_material(ShapeId shape, const Material& material);
  Filter filter(ShapeId shape) const;
  /// Returns the present definition, in the body's frame and rounded to `Real`; it could be added again.
  /// Boxes become polygons; a segment of a chain becomes a segment.
  ShapeDefinition definition(ShapeId shape) const;
  /// Replaces the geometry, which lies in the body's frame as in ShapeDefinition; all else stays. Its
  /// contacts end, and begin anew in the next step if it touches; overlaps with sensors go on if they still
  /// overlap. The body's mass follows, unless it was given. Throws Error (Value) for a segment of a chain.
  void set_geometry(ShapeId shape, const ShapeGeometry& geometry, Vec2d position = {}, double angle = 0);
  double density(ShapeId shape) const;   ///< kg/m^2
  bool sensor(ShapeId shape) const;      ///< true for a sensor
  bool hit_events(ShapeId shape) const;  ///< hard impacts on it are reported
  bool pre_solve(ShapeId shape) const;   ///< its contacts call the pre-solve hook
  void set_filter(ShapeId shape, const Filter& filter);
  /// Sets the density, kg/m^2, >= 0; the body's mass follows, unless it was given.
  void set_density(ShapeId shape, double density);
  /// Turns a shape into a sensor, or back. Its contacts, or overlaps, end.
  void set_sensor(ShapeId shape, bool sensor);
  void set_hit_events(ShapeId shape, bool on);
  void set_pre_solve(ShapeId shape, bool on);
  std::vector<ShapeId> overlapping(ShapeId sensor) const;  ///< shapes in a sensor in the last step

  ChainId create_chain(BodyId body, const ChainDefinition& definition);
  void destroy(ChainId chain);
  bool valid(ChainId chain) const;
  std::vector<ShapeId> segments(ChainId chain) const;
  BodyId body(ChainId chain) const;
  ChainDefinition definition(ChainId chain) const;  ///< as at present; could be added again

  // Joints.
  /// Joins two different bodies of any types. The joint acts while one of them is dynamic and both are
  /// enabled.
  JointId create_joint(BodyId a, BodyId b, const JointDefinition& definition);
  void destroy(JointId joint);
  bool valid(JointId joint) const;
  const JointKind& kind(JointId joint) const;
  void change(JointId joint, const JointKind& kind);  ///< new speeds, limits, targets; wakes the bodies
  JointReading read(JointId joint) const;
  /// Returns the constants of the joint's springs: k = m (2 pi hertz)^2 in N/m or N m/rad, and the damping,
  /// of the effective mass m at the pose in which the joint was created, for the present masses of its
  /// bodies. Throws Error (Unsupported) for a joint without springs. Source:
  /// docs/decisions/constant-springs.md.
  JointStiffness stiffness(JointId joint) const;
  JointDefinition definition(JointId joint) const;  ///< the present one
  /// Sets the loads, N and N m, above which `events().loaded` reports the joint; 0: never. Throws Error
  /// (Value) for a negative number or one that is not finite.
  void set_load_events(JointId joint, double force, double torque);
  std::uint64_t user_data(JointId joint) const;
  void set_user_data(JointId joint, std::uint64_t data);
  std::pair<BodyId, BodyId> bodies(JointId joint) const;

  /// Sets the hook that is called for contacts of shapes with `pre_solve`, before they are solved; false
  /// disables one in this step. An exception ends the step before anything has moved.
  void on_pre_solve(std::function<bool(const ContactReading&)> hook);

  /// Sets the user's filter. It is called for two shapes whose fat AABBs overlap and whose own filters permit
  /// a contact; if it returns false, they do not collide. Existing contacts stay until `set_filter` is called
  /// for one of their shapes, which ends them and calls the filter again. Sensors and queries do not call it.
  /// It is code, like a combine rule: it must depend on the world's state alone, it is not part of snapshots,
  /// and recorded worlds cannot have one. An exception ends the step before anything has moved, except from
  /// continuous collision.
  void on_filter(std::function<bool(ShapeId, ShapeId)> filter);

  /// Returns the 64-bit FNV-1a hash of every body's state: equal on every platform for the same calls.
  std::uint64_t hash() const;

  /// Returns the world's data, for the engine's own extensions (queries, snapshots, force laws):
  /// world_data.h.
  WorldData<Real>& data();
  const WorldData<Real>& data() const;

 private:
  int index_of(BodyId body) const;
  int index_of(ShapeId shape) const;
  int index_of(JointId joint) const;
  int index_of(ChainId chain) const;
  void wake(int body);
  void wake_moved(int body);
  void wake_all();
  void wake_pre_solve_contacts();

  [[noreturn]] static void throw_moved_from();

  /// Owns the data. Every access to data that were moved away throws, so that no call can omit this check.
  class Owned {
   public:
    explicit Owned(OwnedPointer<WorldData<Real>> data) : data_(std::move(data)) {}
    WorldData<Real>& operator*() const {
      if (moved_away()) throw_moved_from();
      return *data_;
    }
    WorldData<Real>* operator->() const { return &**this; }
    bool moved_away() const { return data_.get() == nullptr; }
    WorldData<Real>* release() { return data_.release(); }

   private:
    OwnedPointer<WorldData<Real>> data_;
  };
  Owned data_;
};

using World = BasicWorld<float>;
using DoubleWorld = BasicWorld<double>;

extern template class BasicWorld<float>;
extern template class BasicWorld<double>;

}  // namespace plumb
