#pragma once

#include <functional>
#include <span>

#include "engine/math/vec2.h"

namespace plumb::field {

struct Bounds {
  Vec2d low{}, high{};  ///< m
};

/// Calls `visit(i, j)`, i < j, once for each two boxes that meet. Sorts by the left sides and sweeps, so that
/// it depends on no grid and on no engine.
void for_each_meeting(std::span<const Bounds> boxes, const std::function<void(int, int)>& visit);

}  // namespace plumb::field
