#pragma once

#include "engine/geometry/convex.h"

namespace plumb {

/// What a rigid shape weighs and how it resists turning.
struct ConvexMass {
  double mass = 0;     ///< kg
  Vec2d centroid{};    ///< m, in the corners' frame
  double inertia = 0;  ///< kg m^2, about the centroid
};

/// Of a rounded convex shape of uniform `density`, kg/m^2. Exact but for rounding: the polygon, a rectangle
/// on each edge and a circular sector at each corner. Shapes without area (a segment, a point) weigh nothing.
ConvexMass convex_mass(const Convex<double>& shape, double density);

}  // namespace plumb
