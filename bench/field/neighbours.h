#pragma once

#include <functional>
#include <span>

#include "engine/math/vec2.h"

namespace plumb::field {

struct Bounds {
  Vec2d low{}, high{};  ///< m
};

/// Calls `visit(i, j)`, i < j, once for each pair of overlapping boxes. Sweeps along x over boxes sorted by
/// their left sides, so the result depends on no grid and no engine.
void for_each_meeting(std::span<const Bounds> boxes, const std::function<void(int, int)>& visit);

}  // namespace plumb::field
