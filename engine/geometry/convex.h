#pragma once

#include "engine/math/vec2.h"

namespace plumb {

/// Most corners of a convex shape.
inline constexpr int kMaxCorners = 64;

/// A corner of a convex shape, and the unit outward normal of the edge that leads to the next corner.
template <class Real>
struct Corner {
  Vec2<Real> point{};   ///< m
  Vec2<Real> normal{};  ///< zero where the shape has a single corner
};

/// The convex hull of corners in counter-clockwise order, rounded by a radius: the points no farther than
/// `radius` from the hull. One corner is a disc, two are a capsule (a segment when the radius is 0), whose
/// second normal is the opposite of the first; three or more are a polygon. A view: it owns nothing.
template <class Real>
struct Convex {
  const Corner<Real>* corners = nullptr;
  int count = 0;    ///< 1 .. kMaxCorners
  Real radius = 0;  ///< m, >= 0
};

}  // namespace plumb
