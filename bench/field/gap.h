#pragma once

#include <vector>

#include "bench/field/definitions.h"

namespace plumb::field {

/// A convex core at its present pose, with the radius that enlarges it: a point, a segment or a
/// counter-clockwise polygon.
struct PlacedShape {
  std::vector<Vec2d> core;  ///< m
  double radius = 0;        ///< m
};

/// Returns `geometry` on a body at `state`.
PlacedShape place(const Geometry& geometry, const BodyState& state);

/// Returns the distance between two shapes, m; if they overlap, minus the shortest displacement that
/// separates them. Exact up to rounding: the depth of convex shapes is least along an edge normal of one of
/// them. Those are the normals of their Minkowski difference (Ericson 2005, chapters 5 and 9).
double gap(const PlacedShape& a, const PlacedShape& b);

}  // namespace plumb::field
