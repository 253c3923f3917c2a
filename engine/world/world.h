#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/world/definitions.h"
#include "engine/world/events.h"
#include "engine/world/handles.h"

namespace plumb {

template <class Real>
struct WorldData;

/// A joint as one reads it.
struct JointReading {
  double force = 0, torque = 0;                ///< N, N m: reaction over the last substep
  double linear_error = 0, angular_error = 0;  ///< m, rad: how far the rigid rows are from what they hold
  double angle = 0;                            ///< rad, of b relative to a less the reference angle
  double translation = 0;                      ///< m, along the axis (prismatic, wheel)
  double length = 0;                           ///< m (distance, pulley)
};

/// Two shapes that touch, as the pre-solve hook and `contacts_of` see them.
struct ContactReading {
  ShapeId shape_a{}, shape_b{};
  Vec2d normal{};  ///< from a to b
  int count = 0;
  Vec2d points[2] = {};        ///< m
  double separations[2] = {};  ///< m, negative: overlap
  double impulses[2] = {};     ///< N s, along the normal, of the last substep
  double approach = 0;         ///< m/s, along the normal at the step's start, negative: closing
};

struct WorldCounts {
  int bodies = 0, awake = 0, shapes = 0, contacts = 0, touching = 0, joints = 0;
};

/// A game's world: bodies, shapes and joints that are added, changed and removed while it runs in steps of
/// fixed length. Positions are kept in double, everything else in `Real`; the interface speaks double. SI
/// units, y up, angles in rad, counter-clockwise. Functions that take a handle throw Error (Name) when what
/// it names is gone, and Error (Value) for numbers out of their range; nothing has changed then. Movable, not
/// copyable: a world that was moved away throws Error (Name) at each call.
///
/// Whatever a call could change is awake afterwards. Code of the user's that the world calls (hooks, rules,
/// force laws, visitors of queries) may read it; calls that change it throw Error (Unsupported) from there.
/// What such code throws ends the call; the world goes on. So it does where memory is out: what creates has
/// then changed nothing, another call may be done by half.
template <class Real>
class BasicWorld {
 public:
  explicit BasicWorld(const WorldDefinition& definition = {});
  ~BasicWorld();
  BasicWorld(BasicWorld&&) noexcept;
  BasicWorld& operator=(BasicWorld&&);

  /// Advances by `dt` s in `substeps` substeps: more of them hold stacks and joints better. A body whose
  /// state would not be finite afterwards, or beyond 1e12, is quarantined.
  void step(double dt = 1.0 / 60, int substeps = 4);
  double time() const;  ///< s
  std::int64_t step_count() const;
  const Events& events() const;  ///< of the last step

  /// The user's own rules for contacts that begin from now on; null: the one of the definition. They are
  /// code, and no part of snapshots: set them again in the world that one is restored into. Recorded worlds
  /// cannot have them.
  void combine_with(CombineFunction friction, CombineFunction restitution);

  void set_gravity(Vec2d gravity);
  Vec2d gravity() const;
  void set_sleeping(bool on);
  void set_continuous(bool on);
  /// From the next step on; what the solver before knew of impulses is taken over.
  void set_solver(Solver solver);
  Solver solver() const;
  void set_iterations(int iterations);  ///< sweeps a substep: SequentialImpulses and Jakobsen
  int iterations() const;
  void set_direct_islands(bool on);  ///< whether SoftSteps solves small islands directly
  /// Whether bodies that go bad are quarantined; otherwise Error (Run, or Value for what a force law
  /// returned) ends the call, and a step that it ends is done by half.
  void set_quarantine(bool on);
  WorldCounts counts() const;

  /// Bodies that went bad and what was wrong with them, the first one first. They are where they were before
  /// that step and stay there; nothing touches or finds them, and their joints let go. They can be changed
  /// like any other body.
  std::vector<QuarantineEvent> quarantined() const;
  bool quarantined(BodyId body) const;
  /// Goes on with the state from before it went bad, or the one that was set since, and forgets about it.
  void release(BodyId body);

  // Bodies.
  BodyId create_body(const BodyDefinition& definition, std::span<const ShapeDefinition> shapes = {});
  BodyId create_body(const BodyDefinition& definition, const ShapeDefinition& shape);
  /// Likewise; `made` becomes the list of the shapes' handles, in the order of their definitions.
  BodyId create_body(const BodyDefinition& definition, std::span<const ShapeDefinition> shapes,
                     std::vector<ShapeId>& made);
  void destroy(BodyId body);  ///< with its shapes, contacts and joints
  bool valid(BodyId body) const;
  std::vector<BodyId> bodies() const;  ///< all, in the order of their places

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
  /// A kinematic or dynamic body arrives at the pose after `dt`, if nothing stops it: sets its velocities.
  void move_towards(BodyId body, Vec2d position, double angle, double dt);

  void apply_force(BodyId body, Vec2d force);  ///< N, at the centre of mass, through the next step
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
  void use_densities(BodyId body);  ///< mass follows from the shapes again
  void set_gravity_scale(BodyId body, double scale);
  void set_damping(BodyId body, double linear, double angular);
  void set_locks(BodyId body, bool x, bool y, bool rotation);
  bool awake(BodyId body) const;
  void set_awake(BodyId body, bool awake);  ///< with its whole island
  void set_may_sleep(BodyId body, bool may_sleep);
  bool may_sleep(BodyId body) const;
  double gravity_scale(BodyId body) const;
  double linear_damping(BodyId body) const;   ///< 1/s
  double angular_damping(BodyId body) const;  ///< 1/s
  BodyLocks locks(BodyId body) const;
  std::uint64_t user_data(BodyId body) const;
  const std::string& name(BodyId body) const;
  std::vector<ShapeId> shapes(BodyId body) const;           ///< in the order in which they were made
  std::vector<JointId> joints(BodyId body) const;           ///< likewise
  std::vector<ContactReading> contacts(BodyId body) const;  ///< that have points

  // Shapes.
  ShapeId create_shape(BodyId body, const ShapeDefinition& definition);
  void destroy(ShapeId shape);
  bool valid(ShapeId shape) const;
  BodyId body(ShapeId shape) const;
  std::uint64_t user_data(ShapeId shape) const;
  Material material(ShapeId shape) const;
  void set_material(ShapeId shape, const Material& material);
  Filter filter(ShapeId shape) const;
  /// As it is now, in the body's frame and rounded to `Real`; it could be added again. Boxes are polygons; a
  /// segment of a chain is a segment.
  ShapeDefinition definition(ShapeId shape) const;
  double density(ShapeId shape) const;   ///< kg/m^2
  bool sensor(ShapeId shape) const;      ///< whether it is one
  bool hit_events(ShapeId shape) const;  ///< whether hard impacts on it are reported
  bool pre_solve(ShapeId shape) const;   ///< whether its contacts are asked about
  void set_filter(ShapeId shape, const Filter& filter);
  std::vector<ShapeId> overlapping(ShapeId sensor) const;  ///< what a sensor saw in the last step

  ChainId create_chain(BodyId body, const ChainDefinition& definition);
  void destroy(ChainId chain);
  bool valid(ChainId chain) const;
  std::vector<ShapeId> segments(ChainId chain) const;
  BodyId body(ChainId chain) const;
  ChainDefinition definition(ChainId chain) const;  ///< as it is now, likewise

  // Joints.
  JointId create_joint(BodyId a, BodyId b, const JointDefinition& definition);
  void destroy(JointId joint);
  bool valid(JointId joint) const;
  const JointKind& kind(JointId joint) const;
  void change(JointId joint, const JointKind& kind);  ///< new speeds, limits, targets; wakes the bodies
  JointReading read(JointId joint) const;
  JointDefinition definition(JointId joint) const;  ///< as it is now
  std::uint64_t user_data(JointId joint) const;
  std::pair<BodyId, BodyId> bodies(JointId joint) const;

  /// Called for contacts of shapes that ask for it, before they are solved; false: not in this step. What it
  /// throws ends the step, before anything has moved.
  void on_pre_solve(std::function<bool(const ContactReading&)> hook);

  /// 64-bit FNV-1a over the bits of every body's state: equal on every platform for the same calls.
  std::uint64_t hash() const;

  /// What the world consists of, for the engine's own extensions (queries, snapshots, force laws):
  /// world_data.h.
  WorldData<Real>& data();
  const WorldData<Real>& data() const;

 private:
  int place(BodyId body) const;
  int place(ShapeId shape) const;
  int place(JointId joint) const;
  int place(ChainId chain) const;
  void wake(int body);
  void wake_moved(int body);
  void wake_all();
  void wake_asked();

  std::unique_ptr<WorldData<Real>> data_;
};

using World = BasicWorld<float>;
using DoubleWorld = BasicWorld<double>;

extern template class BasicWorld<float>;
extern template class BasicWorld<double>;

}  // namespace plumb
