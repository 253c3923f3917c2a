#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "engine/precise/dynamics/feature_shape.h"
#include "engine/scene/scene.h"

namespace plumb::precise {

/// State of motion of a body, with its acceleration.
struct Motion {
  BodyState state{};
  Vec2d acceleration{};             ///< m/s^2
  double angular_acceleration = 0;  ///< rad/s^2
};

/// Partition of the scene's bodies by how they are moved, derived before anything is allocated.
struct ScenePartition {
  std::vector<std::size_t> ballistic;   ///< on polynomials: static, kinematic, or under constant forces alone
  std::vector<std::size_t> integrated;  ///< dynamic bodies with joints, with shapes that may touch, or with
                                        ///< forces that depend on the motion
  bool constant_forces = false;         ///< apart from contacts, only constant forces act on these
  std::vector<FeatureShape> shapes;     ///< of shapes that may touch another one
  std::vector<std::pair<std::size_t, std::size_t>>
      non_colliding;             ///< bodies, first < second, whose joint keeps them from touching; sorted
  std::vector<double> switches;  ///< s, > 0: when forces are switched, ascending
};

ScenePartition partition_scene(const Scene& scene);

/// Returns the scene without the laws that act on none of `bodies`, which are in ascending order.
Scene with_laws_on(const Scene& scene, const std::vector<std::size_t>& bodies);

/// Returns true if body types, filters and joints allow the pair's shapes to touch.
bool may_collide(const Scene& scene, const ScenePartition& partition, std::size_t body_a, const Filter& a,
                 std::size_t body_b, const Filter& b);

/// The scene's own scales, by which errors are measured.
struct Scales {
  double length = 1;  ///< m: the largest extent of an integrated body, joint or lever
  double speed = 1;   ///< m/s: the speed that the scene's accelerations reach over that length
};

Scales scales_of(const Scene& scene, const ScenePartition& partition);

}  // namespace plumb::precise
