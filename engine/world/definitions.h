#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "engine/core/task_system.h"
#include "engine/joints/definitions.h"
#include "engine/scene/scene.h"
#include "engine/world/integrator.h"
#include "engine/world/solver.h"

/// Definitions of a world's bodies, shapes and joints: plain data in SI units, y up, double precision.
namespace plumb {

using ShapeGeometry = std::variant<Circle, Box, Capsule, Polygon, Segment>;

struct Material {
  double friction = 0.6;          ///< Coulomb's coefficient, >= 0
  double restitution = 0;         ///< Newton's coefficient, 0..1
  double rolling_resistance = 0;  ///< lever arm of rolling friction divided by the rounding radius, >= 0
  double surface_speed = 0;       ///< m/s, of the surface, positive to the right of someone standing on it
  friend bool operator==(const Material&, const Material&) = default;
};

struct ShapeDefinition {
  ShapeGeometry geometry = Circle{0.5};
  Vec2d position{};    ///< m, of the geometry's origin in the body's frame
  double angle = 0;    ///< rad, in the body's frame
  double density = 1;  ///< kg/m^2, >= 0
  Material material{};
  Filter filter{};
  bool sensor = false;      ///< reports overlaps, and collides with nothing
  bool hit_events = false;  ///< reports impacts faster than a threshold
  bool pre_solve = false;   ///< calls the pre-solve hook
  std::uint64_t user_data = 0;
};

/// A line of one-sided segments: the front is to the right when walking from point to point. Nothing catches
/// on its internal edges.
struct ChainDefinition {
  std::vector<Vec2d> points{};  ///< m, in the body's frame; 2 or more, 3 or more when closed
  bool closed = false;          ///< the last point is joined to the first
  Material material{};          ///< of all segments, unless `materials` has some
  Filter filter{};
  bool sensor = false;      ///< each of its segments reports overlaps, and collides with nothing
  bool hit_events = false;  ///< reports impacts faster than a threshold
  bool pre_solve = false;   ///< calls the pre-solve hook
  std::uint64_t user_data = 0;
  std::vector<Material> materials{};  ///< empty, or one per segment, in the order of the points
};

/// Mass of a body that does not follow from its shapes' densities.
struct MassProperties {
  double mass = 1;     ///< kg, > 0
  Vec2d centre{};      ///< m, centre of mass in the body's frame; kinematic bodies rotate about their origin
                       ///< instead
  double inertia = 1;  ///< kg m^2 about the centre of mass, > 0
};

/// Locks a body's position along x or y of the world, or its angle.
struct BodyLocks {
  bool x = false, y = false, rotation = false;
  friend bool operator==(const BodyLocks&, const BodyLocks&) = default;
};

struct BodyDefinition {
  std::string name{};  ///< for messages
  BodyType type = BodyType::Dynamic;
  Vec2d position{};             ///< m, of the body's origin
  double angle = 0;             ///< rad
  Vec2d velocity{};             ///< m/s, of the centre of mass; of a kinematic body's origin
  double angular_velocity = 0;  ///< rad/s
  std::optional<MassProperties> mass{};
  double gravity_scale = 1;
  double linear_damping = 0;   ///< 1/s: the velocity decays as exp(-damping t), >= 0
  double angular_damping = 0;  ///< 1/s: the same for the angular velocity
  bool lock_x = false, lock_y = false, lock_rotation = false;
  bool may_sleep = true;
  bool awake = true;
  std::uint64_t user_data = 0;
  bool continuous = true;  ///< prevents tunnelling; false saves time
};

/// Kind of a joint, and the loads that break it or are reported.
struct JointDefinition {
  JointKind kind = RevoluteDefinition{};
  bool collide = false;     ///< the joined bodies may collide
  double break_force = 0;   ///< N, mean of a step; 0: never
  double break_torque = 0;  ///< N m, 0: never
  std::uint64_t user_data = 0;
  double report_force = 0;   ///< N, load above which an event is raised in each step; 0: never
  double report_torque = 0;  ///< N m, 0: never
};

/// Combines the coefficients of two shapes into that of their contact. Must be a pure function, symmetric in
/// its arguments: a world is only as deterministic as its rules.
using CombineFunction = double (*)(double a, double b);

/// Speeds at which behaviour changes, m/s. Negative selects the default, from the shapes' sizes or gravity,
/// so that scenes of all sizes behave alike.
struct Thresholds {
  double hit = -1;     ///< approach speed at which hit events begin; default: the smaller extent per second
  double bounce = -1;  ///< approach speed below which nothing bounces; default: 4 steps of gravity
  double sleep = -1;   ///< speed up to which a body may fall asleep; default: 0.05 of its extents per second,
                       ///< and a displacement of 0.0025 of them, or less, in half a second
  friend bool operator==(const Thresholds&, const Thresholds&) = default;
};

/// Settings of the whole world.
struct WorldDefinition {
  Vec2d gravity{0, -9.81};  ///< m/s^2
  Combine combine_friction = Combine::GeometricMean;
  Combine combine_restitution = Combine::Maximum;
  bool sleeping = true;    ///< islands at rest fall asleep until something touches them
  bool continuous = true;  ///< continuous collision: fast bodies do not tunnel
  Solver solver = Solver::SoftSteps;
  Integrator integrator = Integrator::VelocityVerlet;  ///< of SoftSteps and Direct
  int iterations = 10;         ///< iterations per substep, 1..1000: SequentialImpulses and Jakobsen
  bool direct_islands = true;  ///< SoftSteps solves small islands directly if iterations would not hold them
  bool quarantine = true;      ///< takes non-finite bodies out of the simulation; false: Error ends the step
  /// Number of threads that share a step, 1..64: the calling thread, and a pool of the world or of the game
  /// (BasicWorld::set_task_system). Every number gives the same bits. Snapshots and recordings do not store
  /// it. The calling thread alone steps small worlds.
  int threads = kUsualThreads;
  Thresholds thresholds{};
};

}  // namespace plumb
