#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/geometry/aabb.h"
#include "engine/geometry/convex.h"
#include "engine/math/pose.h"

namespace plumb {

/// The smallest box along the axes around a shape whose frame lies at `pose`.
template <class Real>
inline Aabb<Real> convex_bounds(const Convex<Real>& shape, const Pose<Real>& pose) {
  const auto place = [&](int i) { return pose.rotation * shape.corners[i].point; };
  const auto cover = [](const Aabb<Real>& box, Vec2<Real> p) {
    return Aabb<Real>{{std::min(box.lower.x, p.x), std::min(box.lower.y, p.y)},
                      {std::max(box.upper.x, p.x), std::max(box.upper.y, p.y)}};
  };
  const Vec2<Real> first = place(0);
  Aabb<Real> box{first, first};
  if (shape.count == 4) {  // boxes, without a loop
    box = cover(cover(cover(box, place(1)), place(2)), place(3));
  } else {
    for (int i = 1; i < shape.count; ++i) box = cover(box, place(i));
  }
  const Vec2<Real> rounding{shape.radius, shape.radius};
  return {(pose.position + box.lower) - rounding, (pose.position + box.upper) + rounding};
}

/// The distance from `point` to the farthest point of the shape, m, both in the corners' frame.
template <class Real>
inline Real convex_extent(const Convex<Real>& shape, Vec2<Real> point) {
  Real farthest = 0;
  for (int i = 0; i < shape.count; ++i)
    farthest = std::max(farthest, length_squared(shape.corners[i].point - point));
  return std::sqrt(farthest) + shape.radius;
}

/// Half the shape's width in the direction in which it is thinnest, m: what moves farther than this in a
/// step may pass through something thin. For a segment without radius: 0.
template <class Real>
inline Real convex_half_width(const Convex<Real>& shape) {
  if (shape.count < 3) return shape.radius;
  // The thinnest direction is across an edge (rotating calipers).
  Real thinnest = std::numeric_limits<Real>::max();
  for (int i = 0; i < shape.count; ++i) {
    Real depth = 0;
    for (int j = 0; j < shape.count; ++j)
      depth = std::max(depth, dot(shape.corners[i].normal, shape.corners[i].point - shape.corners[j].point));
    thinnest = std::min(thinnest, depth);
  }
  return thinnest / 2 + shape.radius;
}

}  // namespace plumb
