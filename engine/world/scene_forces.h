#pragma once

#include <vector>

#include "engine/forces/laws.h"
#include "engine/world/add_scene.h"

namespace plumb {

/// The force laws of a scene in a world that `add_scene` has put it into.
template <class Real>
class SceneForces {
 public:
  /// The scene is valid, and `parts` are what became of it.
  SceneForces(const Scene& scene, const SceneParts& parts);

  bool empty() const { return laws_.empty() && springs_.empty(); }

  /// Adds the laws' forces of the step of `dt` s that comes next. They are those at the step's middle, where
  /// the motion without joints and contacts leads, so that bodies in free flight move as by the midpoint
  /// method; laws that depend on time act with their mean over the step. Springs too stiff for the step act
  /// as by the implicit midpoint method, along their line: they swing too slowly, and gain and lose nothing.
  void apply(BasicWorld<Real>& world, double dt);

 private:
  void place(const BasicWorld<Real>& world);
  void advance(const BasicWorld<Real>& world, double dt);
  struct Spring {
    SpringForceLaw<double> law;
    bool stiff = false;             ///< in the step that comes next
    Wrench<double> on_a{}, on_b{};  ///< where it is
  };
  void stiffen(const BasicWorld<Real>& world, double dt);
  void add_springs(bool stiff);  ///< those that are stiff too, or the others alone

  Forces<double> laws_;  // all but springs
  std::vector<Spring> springs_;
  std::vector<BodyId> ids_;  // by body
  std::vector<std::size_t> acted_on_;
  std::vector<Vec2d> gravity_;  // m/s^2, by body
  std::vector<Pose<double>> poses_;
  std::vector<Twist<double>> twists_;
  std::vector<Wrench<double>> wrenches_;
};

}  // namespace plumb
