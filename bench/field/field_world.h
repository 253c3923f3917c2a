#pragma once

#include <memory>
#include <span>
#include <string>

#include "bench/field/definitions.h"
#include "bench/field/mass.h"

namespace plumb::field {

/// Step settings. Each engine uses those that it has, and otherwise its documented defaults.
struct WorldSettings {
  Vec2d gravity{0, -10};                                 ///< m/s^2
  double dt = 1.0 / 60;                                  ///< s
  int substeps = 4;                                      ///< for engines with substeps
  int velocity_iterations = 8, position_iterations = 3;  ///< of Box2D 2.4
  int iterations = 10;                                   ///< for Chipmunk, and for plumb's iterative solvers
  std::string solver{};  ///< for plumb: name of the solver; empty: its default
  int threads = 1;       ///< for engines that share a step among threads
  bool sleeping = false;
  bool continuous = true;
  bool profiling = false;  ///< for engines that time their stages
};

/// An engine's world. A call costs one virtual call, which is negligible beside a step.
class FieldWorld {
 public:
  virtual ~FieldWorld() = default;

  /// Creates a body. Dynamic bodies get the given mass, whatever the engine would compute from the densities.
  virtual BodyHandle create_body(const BodyDefinition& body, std::span<const ShapeDefinition> shapes,
                                 const MassProperties& mass) = 0;
  /// Destroys a body with its shapes and joints.
  virtual void destroy_body(BodyHandle body) = 0;
  virtual void create_revolute(BodyHandle a, BodyHandle b, const RevoluteDefinition& joint) = 0;
  virtual void set_velocity(BodyHandle body, Vec2d velocity, double spin) = 0;
  virtual void step() = 0;

  virtual BodyState state(BodyHandle body) const = 0;
  virtual Counts counts() const = 0;
  virtual Settings settings() const = 0;
  /// Returns the mean wall time of each stage of a step, ns, by the stage's name; empty unless it is
  /// measured.
  virtual StageTimes profile() const { return {}; }
  /// Forgets the times so far.
  virtual void restart_profile() {}
};

}  // namespace plumb::field
