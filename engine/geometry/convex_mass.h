#pragma once

#include "engine/geometry/convex.h"

namespace plumb {

/// Mass properties of a rigid shape.
struct ConvexMass {
  double mass = 0;     ///< kg
  Vec2d centroid{};    ///< m, in the corners' frame
  double inertia = 0;  ///< kg m^2, about the centroid
};

/// Computes the mass properties of a rounded convex shape of uniform `density`, kg/m^2. Exact to rounding:
/// the sum of the polygon, a rectangle on each edge and a circular sector at each corner. Shapes without area
/// (a segment, a point) have no mass.
ConvexMass convex_mass(const Convex<double>& shape, double density);

}  // namespace plumb
