#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "engine/scene/formula.h"
#include "engine/scene/prescribed_path.h"
#include "engine/world/add_scene.h"
#include "engine/world/world.h"

namespace plumb {

/// Prescribed motions and drives of a scene in a world to which `add_scene` has added it.
template <class Real>
class SceneDrives {
 public:
  /// The scene must be valid, and `parts` be the result of `add_scene`.
  SceneDrives(const Scene& scene, const SceneParts& parts);

  bool empty() const { return prescribed_.empty() && driven_.empty(); }

  /// Gives each prescribed body the velocity that takes it to its place at the end of the next step of `dt`
  /// s. Gives each motor with a drive the drive's mean speed over it, from the speeds at the start, middle
  /// and end (Simpson's rule). Joints that have been destroyed are left out.
  void apply(BasicWorld<Real>& world, double dt) const;

  /// Sets the velocities of prescribed bodies to those of their motions at a time, s: in the world they are
  /// the means over the last step. `states`: by body of the scene.
  void read_velocities(double time, std::span<BodyState> states) const;

 private:
  struct Prescribed {
    std::size_t index;  ///< in the scene
    BodyId body;
    PrescribedPath path;
  };
  struct Driven {
    JointId joint;
    Formula speed;
  };
  std::vector<Prescribed> prescribed_;
  std::vector<Driven> driven_;
};

}  // namespace plumb
