#pragma once

#include <span>

#include "engine/math/vec2.h"

namespace plumb {

/// The displacements d with dot(normal, d) >= least.
struct HalfPlane {
  Vec2d normal{};    ///< unit
  double least = 0;  ///< m (or m/s, for velocities)
};

struct PlaneSolution {
  Vec2d point{};
  bool feasible = true;  ///< false: no point is in all of them; this one is as little outside as was found
};

/// The point of all half planes that is nearest to `wanted`. Exact but for roundings, without iteration: it
/// is `wanted` itself, or lies on one border, or where two of them cross. So what is in a corner stays there.
PlaneSolution solve_planes(std::span<const HalfPlane> planes, Vec2d wanted);

}  // namespace plumb
