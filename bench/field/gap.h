#pragma once

#include <vector>

#include "bench/field/definitions.h"

namespace plumb::field {

/// A convex core and what it is grown by, where it is now: a point, a segment or a counter-clockwise polygon.
struct PlacedShape {
  std::vector<Vec2d> core;  ///< m
  double radius = 0;        ///< m
};

/// `geometry` on a body at `state`.
PlacedShape place(const Geometry& geometry, const BodyState& state);

/// The distance between two shapes; where they overlap, less the shortest way that parts them, m. Exact up to
/// rounding: the overlap of convex shapes is least along a normal of an edge of one of them, because those
/// are the edges of their Minkowski difference (Ericson 2005, chapters 5 and 9).
double gap(const PlacedShape& a, const PlacedShape& b);

}  // namespace plumb::field
