#pragma once

#include <vector>

#include "engine/forces/laws.h"
#include "engine/world/add_scene.h"
#include "engine/world/forces/elastic_step.h"

namespace plumb {

/// Force laws of a scene in a world to which `add_scene` has added it.
template <class Real>
class SceneForces {
 public:
  /// The scene must be valid, and `parts` be the result of `add_scene`.
  SceneForces(const Scene& scene, const SceneParts& parts);

  bool empty() const { return acted_on_.empty(); }

  /// Adds the laws' forces for the next step of `dt` s. They are evaluated at the middle of the step,
  /// predicted without joints and contacts, so that free flight follows the midpoint method. Laws that depend
  /// on time act with their mean over the step. Drag never reverses a body's motion, however strong it is.
  /// Springs conserve energy, however stiff they are (elastic_step.h). If the phase of an oscillation
  /// advances by theta = omega dt per step, its frequency is too low by the fraction theta^2 / 12.
  void apply(BasicWorld<Real>& world, double dt);

  /// Does the same with the forces at the start of the step, as the Euler schemes do.
  void apply_at_start(BasicWorld<Real>& world, double dt);

 private:
  void read_states(const BasicWorld<Real>& world);
  void advance_to_midpoint(const BasicWorld<Real>& world, double dt);
  /// A body at the start of the step, as springs need it.
  struct SpringBody {
    int body = 0;  ///< in `elastic_`
    Rotation<double> rotation{};
    Twist<double> start{};
  };
  /// All drag on a body.
  struct Drag {
    double linear = 0;     ///< N s/m
    double quadratic = 0;  ///< N s^2/m^2
    double angular = 0;    ///< N m s
    double current = 0;    ///< N s/m: drag force over velocity in the next step
  };
  void apply_wrenches(BasicWorld<Real>& world);
  void add_drag();
  void prepare_springs(const BasicWorld<Real>& world, double dt);
  void add_springs(double dt);
  void add_springs_at_start();

  Forces laws_;              // of all laws except springs and drag
  std::vector<Drag> drags_;  // by body
  std::vector<SpringForceLaw> springs_;
  ElasticStep elastic_;
  std::vector<SpringBody> spring_bodies_;  // by body
  bool uses_midpoint_ = false;             // some laws depend on the motion at the middle of a step
  std::vector<BodyId> ids_;                // by body
  std::vector<std::size_t> acted_on_;
  std::vector<Vec2d> gravity_;  // m/s^2, by body
  std::vector<Pose<double>> poses_;
  std::vector<Twist<double>> twists_;
  std::vector<Wrench<double>> wrenches_;
};

}  // namespace plumb
