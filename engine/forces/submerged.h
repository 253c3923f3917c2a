#pragma once

#include "engine/geometry/convex.h"

namespace plumb {

/// The part of a shape below y = 0.
struct Submerged {
  double area = 0;   ///< m^2
  Vec2d centroid{};  ///< m; zero without area
};

/// Exact for discs, capsules, polygons and rounded ones. By Green's theorem the area is the integral of -y dx
/// along the outline's parts below y = 0; the water line that closes them adds nothing.
Submerged submerged_part(const Convex<double>& shape);

}  // namespace plumb
