#pragma once

#include <vector>

#include "engine/math/pose.h"
#include "engine/world/world.h"

namespace plumb {

/// Where the bodies of a world were before its last step, so that it can be drawn between two steps: frames
/// that come at other times than steps do then show even motion.
template <class Real>
class PastPoses {
 public:
  /// Keeps where the bodies are now: to be called before each step. Allocates only while the world grows.
  void keep(const BasicWorld<Real>& world);

  /// The pose of the centre of mass of the body at a place of `data`, `fraction` (0..1) of the way from where
  /// it was to where it is. Bodies that are younger than what was kept are where they are.
  Pose<double> between(const WorldData<Real>& data, int body, double fraction) const;

 private:
  struct Past {
    Vec2d position{};              ///< m, of the centre of mass
    double angle = 0;              ///< rad
    std::uint32_t generation = 0;  ///< even: the place was free
  };
  std::vector<Past> past_;  // by the body's place
};

extern template class PastPoses<float>;
extern template class PastPoses<double>;

}  // namespace plumb
