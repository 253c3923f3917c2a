#pragma once

#include <type_traits>

#include "engine/geometry/convex.h"
#include "engine/world/definitions.h"

namespace plumb {

/// A convex shape for queries, in double precision and in its own frame. Create it once for many queries;
/// circles, boxes, capsules and segments do not allocate. Throws Error (Value) in the same cases as creating
/// such a shape in a world.
class QueryShape {
 public:
  QueryShape(const ShapeGeometry& geometry);
  template <class Geometry>
  requires(!std::is_same_v<Geometry, ShapeGeometry> && std::is_constructible_v<ShapeGeometry, Geometry>)
      QueryShape(const Geometry& geometry)
      : QueryShape(ShapeGeometry(geometry)) {}

  /// Returns a box of half sizes >= 0, m: a line or a point if they are 0.
  static QueryShape box(double half_width, double half_height);

  /// Returns a view of this object.
  Convex<double> convex() const { return {corners_, count_, radius_}; }
  Vec2d middle() const;  ///< m, mean of the corners

 private:
  QueryShape() = default;
  void add(Vec2d point) { corners_[count_++].point = point; }
  void set_normals();

  Corner<double> corners_[kMaxCorners];
  int count_ = 0;
  double radius_ = 0;  // m
};

}  // namespace plumb
