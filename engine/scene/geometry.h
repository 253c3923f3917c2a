#pragma once

#include <variant>
#include <vector>

#include "engine/math/vec2.h"

/// The geometries of shapes, in SI units, each in its own frame.
namespace plumb {

struct Circle {
  double radius = 0;  ///< m, > 0
  friend bool operator==(const Circle&, const Circle&) = default;
};

struct Box {
  double width = 0;   ///< m, > 0, along the shape's x
  double height = 0;  ///< m, > 0, along the shape's y
  friend bool operator==(const Box&, const Box&) = default;
};

/// The points no farther than `radius` from the segment.
struct Capsule {
  Vec2d start{}, end{};  ///< m
  double radius = 0;     ///< m, > 0
  friend bool operator==(const Capsule&, const Capsule&) = default;
};

/// The convex hull of points, rounded by a radius.
struct Polygon {
  std::vector<Vec2d> points{};  ///< m, 3 or more that do not lie on a line, in any order
  double radius = 0;            ///< m, >= 0
  friend bool operator==(const Polygon&, const Polygon&) = default;
};

/// A line without thickness, solid from both sides. It has no mass.
struct Segment {
  Vec2d start{}, end{};  ///< m
  friend bool operator==(const Segment&, const Segment&) = default;
};

/// A line of segments that collides on its front only (to the right of the direction from point to point),
/// without internal edges at its corners. It has no mass.
struct Chain {
  std::vector<Vec2d> points{};  ///< m, 2 or more; 3 or more when closed
  bool closed = false;          ///< the last point is joined to the first
  friend bool operator==(const Chain&, const Chain&) = default;
};

using Geometry = std::variant<Circle, Box, Capsule, Polygon, Segment, Chain>;

/// Mass properties of a geometry of uniform density, exact up to rounding. Lines have none.
struct Extent {
  double area = 0;              ///< m^2
  Vec2d centroid{};             ///< m, in the geometry's frame
  double gyration_squared = 0;  ///< m^2: I/m about the centroid
};

/// Computes I/m as r^2/2 for a disc and (w^2 + h^2)/12 for a box. Others are sums of triangles, rectangles on
/// their edges and circular sectors at their corners, by the parallel axis theorem.
Extent extent_of(const Geometry& geometry);

/// Returns the largest distance of a point of the geometry from its frame's origin, m.
double reach_of(const Geometry& geometry);

/// Returns the corners of the convex hull of `points`, counter-clockwise, from the lowest of the leftmost;
/// points on an edge are left out. Fewer than 3 when all points lie on a line.
std::vector<Vec2d> convex_corners(std::vector<Vec2d> points);

}  // namespace plumb
