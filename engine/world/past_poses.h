#pragma once

#include <vector>

#include "engine/math/pose.h"
#include "engine/world/world.h"

namespace plumb {

/// Poses of a world's bodies before its last step, for render interpolation: motion then looks smooth even if
/// frames are drawn at other times than steps.
template <class Real>
class PastPoses {
 public:
  /// Stores the present poses; call it before each step. Allocates only while the world grows.
  void keep(const BasicWorld<Real>& world);

  /// Returns the interpolated pose of the centre of mass of body `body` of `data`, at `fraction` (0..1)
  /// between the stored and the present pose. A body created after the poses were stored gets its present
  /// pose.
  Pose<double> between(const WorldData<Real>& data, int body, double fraction) const;
  /// Does the same for the pose of its origin.
  BodyPose pose_between(const BasicWorld<Real>& world, BodyId body, double fraction) const;
  /// Returns the body's angle at `fraction`, rad; it counts whole turns.
  double angle_between(const WorldData<Real>& data, int body, double fraction) const;

 private:
  struct Stored {
    Vec2d position{};              ///< m, of the centre of mass
    double angle = 0;              ///< rad
    std::uint32_t generation = 0;  ///< even: the slot was free
  };
  const Stored* find(const WorldData<Real>& data, int body) const;
  std::vector<Stored> stored_;  // by the body's index
};

extern template class PastPoses<float>;
extern template class PastPoses<double>;

}  // namespace plumb
