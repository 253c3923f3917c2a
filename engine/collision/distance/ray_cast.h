#pragma once

#include "engine/geometry/convex.h"

namespace plumb {

/// First hit of a ray on a shape, in the shape's frame.
template <class Real>
struct RayHit {
  bool hit = false;
  Real fraction = 1;    ///< of the translation, 0 .. 1; 1 without a hit
  Vec2<Real> point{};   ///< m, on the surface
  Vec2<Real> normal{};  ///< unit, outward
};

/// The point of a surface that is nearest to a given one.
template <class Real>
struct SurfacePoint {
  Vec2<Real> point{};   ///< m
  Vec2<Real> normal{};  ///< unit, outward
  Real distance = 0;    ///< m, negative inside the shape
};

/// Finds the first point of `shape` on the ray from `origin` to `origin + translation` (m, in the shape's
/// frame). A ray that starts inside or on the surface hits nothing: it has no point of entry. Exact but for
/// roundings: edges and arcs, no iteration. Computed in double precision for both types of Real.
///
/// A ray that misses a shape with sharp corners by no more than `tolerance` (m, the rounding of the corners)
/// hits the edge beside which it passes: no ray slips through the seam of two shapes that were placed side by
/// side.
template <class Real>
RayHit<Real> ray_cast(const Convex<Real>& shape, Vec2<Real> origin, Vec2<Real> translation,
                      double tolerance = 0);

/// Does the same for a chain segment, which is hit only from its front: the right side of the direction from
/// its first corner to its second.
template <class Real>
RayHit<Real> ray_cast_one_sided(const Convex<Real>& segment, Vec2<Real> origin, Vec2<Real> translation,
                                double tolerance = 0);

/// Returns true if `point` (m, in the shape's frame) is in the shape or on its surface.
template <class Real>
bool contains(const Convex<Real>& shape, Vec2<Real> point);

/// Returns the point of the surface nearest to `point` (m, in the shape's frame), which may lie inside or
/// outside.
template <class Real>
SurfacePoint<Real> nearest_point(const Convex<Real>& shape, Vec2<Real> point);

}  // namespace plumb
