#pragma once

#include <span>

#include "engine/math/vec2.h"

namespace plumb {

/// The half plane of displacements d with dot(normal, d) >= offset.
struct HalfPlane {
  Vec2d normal{};     ///< unit
  double offset = 0;  ///< m (or m/s, for velocities)
};

struct PlaneSolution {
  Vec2d point{};
  bool feasible = true;  ///< false: no point is inside all; this is the one least outside
};

/// Returns the point inside all half planes that is nearest to `target`, exact to rounding and without
/// iteration. It is `target` itself, or lies on one border or at the intersection of two, so a character in a
/// corner stays there.
PlaneSolution solve_planes(std::span<const HalfPlane> planes, Vec2d target);

}  // namespace plumb
