#pragma once

#include <span>
#include <vector>

#include "engine/geometry/convex.h"
#include "engine/math/pose.h"

namespace plumb {

/// The corners of a convex shape during construction: in double, rounded to the world's precision at the end.
using Corners = std::vector<Corner<double>>;

/// Returns how far (m) an outline may change when it is placed at `position` (m) and its corners become
/// numbers of the relative spacing `spacing`: eight roundings of the farthest one, in double 2e-15 of its
/// distance from the origin, in float 1e-6.
double outline_rounding(std::span<const Vec2d> points, double spacing, Vec2d position = {});

/// Returns the corners of the convex hull, counter-clockwise from the leftmost (then lowest) point. Corners
/// are dropped only as far as the outline changes by no more than `detail` (m), or by the rounding in double
/// if that is larger: an edge that the numbers cannot hold has no direction. Throws Error about "points" of
/// "shape": not finite, thinner than 1e-5 of the extent, or more than kMaxCorners corners left.
Corners convex_hull(std::span<const Vec2d> points, double detail = 0);

/// Returns the corners of a box of half sizes > 0 about `center`, m. Its opposite normals are exact negatives
/// of each other.
Corners box_corners(double half_width, double half_height, Vec2d center = {}, Rotation<double> rotation = {});

/// Returns a capsule's two corners, the ends of its axis, m, or one corner, a disc's, if both are the same
/// point.
Corners capsule_corners(Vec2d first, Vec2d second);

/// Returns a disc's only corner.
Corners disc_corner(Vec2d center);

/// Transforms the corners from their frame, which lies at `pose`.
Corners transformed(std::span<const Corner<double>> corners, const Pose<double>& pose);

/// Translates the corners by `by`.
Corners translated(std::span<const Corner<double>> corners, Vec2d by);

}  // namespace plumb
