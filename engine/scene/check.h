#pragma once

#include <cstddef>

#include "engine/scene/scene.h"

namespace plumb {

/// A thing of a scene: the scene itself, or one entry of one of its lists.
struct Place {
  enum class List { None, Bodies, Joints, Forces };
  List list = List::None;
  std::size_t index = 0;
};

/// Numbers of a scene are at most this large, and those that must be positive at least its reciprocal: no
/// product of three (m v^2, m r^2) overflows, and no reciprocal of one (1 / (m r^2)) does.
inline constexpr double kLargest = 1e100;
inline constexpr double kSmallest = 1e-100;

/// `validate`, which keeps `place` at the thing it is looking at: when it throws, that is the culprit.
void check(const Scene& scene, Place& place);

}  // namespace plumb
