#pragma once

#include <cstddef>

#include "engine/scene/scene.h"

namespace plumb {

/// Identifies a part of a scene: the scene itself, or one entry of one of its lists.
struct SceneLocation {
  enum class List { None, Bodies, Joints, Forces, Drives };
  List list = List::None;
  std::size_t index = 0;
};

/// Largest magnitude of a scene's numbers; those that must be positive are at least its reciprocal. No
/// product of three (m v^2, m r^2) overflows, nor does the reciprocal of one (1 / (m r^2)).
inline constexpr double kLargest = 1e100;
inline constexpr double kSmallest = 1e-100;

/// Validates the scene and keeps `location` at the part being checked, so that after a throw it is the
/// invalid part.
void check(const Scene& scene, SceneLocation& location);

}  // namespace plumb
