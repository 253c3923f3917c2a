#pragma once

#include <span>
#include <vector>

#include "engine/geometry/convex.h"
#include "engine/math/pose.h"

namespace plumb {

/// The corners of a convex shape during construction: in double, rounded to the world's precision at the end.
using Corners = std::vector<Corner<double>>;

/// Returns the corners of the convex hull, counter-clockwise from the leftmost (then lowest) point. Points
/// nearer than 1e-5 of the hull's extent to another corner, or to the line between their neighbours, are
/// dropped. Throws Error about "points" of "shape": not finite, no area (three points in a line), or more
/// than kMaxCorners corners left.
Corners convex_hull(std::span<const Vec2d> points);

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
