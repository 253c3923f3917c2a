#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

#include "engine/geometry/aabb.h"
#include "engine/geometry/convex.h"
#include "engine/math/pose.h"

#if defined(__SSE2__) && !defined(PLUMB_SCALAR)
#include <emmintrin.h>
#define PLUMB_BOUNDS_SSE2
#endif

namespace plumb {

#ifdef PLUMB_BOUNDS_SSE2
/// Computes the bounds of shapes of four corners with SSE, two corners at a time. Gives the same bits as the
/// general function below.
inline Aabb<float> bounds_of_four(const Convex<float>& shape, const Pose<float>& pose) {
  const float c = pose.rotation.c, s = pose.rotation.s;
  const __m128 along_x = _mm_setr_ps(c, s, c, s), along_y = _mm_setr_ps(-s, c, -s, c);
  const auto place_two = [&](int i) {
    const auto pair = [](const Vec2<float>& p) { return reinterpret_cast<const __m64*>(&p.x); };
    const __m128 points = _mm_loadh_pi(_mm_loadl_pi(_mm_setzero_ps(), pair(shape.corners[i].point)),
                                       pair(shape.corners[i + 1].point));
    const __m128 x = _mm_shuffle_ps(points, points, _MM_SHUFFLE(2, 2, 0, 0)),
                 y = _mm_shuffle_ps(points, points, _MM_SHUFFLE(3, 3, 1, 1));
    return _mm_add_ps(_mm_mul_ps(along_x, x), _mm_mul_ps(along_y, y));
  };
  const __m128 first = place_two(0), second = place_two(2);
  const __m128 least = _mm_min_ps(first, second), most = _mm_max_ps(first, second);
  const __m128 lower = _mm_min_ps(least, _mm_movehl_ps(least, least)),
               upper = _mm_max_ps(most, _mm_movehl_ps(most, most));
  const float x = pose.position.x, y = pose.position.y, r = shape.radius;
  const __m128 box =
      _mm_add_ps(_mm_add_ps(_mm_movelh_ps(lower, upper), _mm_setr_ps(x, y, x, y)), _mm_setr_ps(-r, -r, r, r));
  Aabb<float> bounds;
  _mm_storeu_ps(&bounds.lower.x, box);
  return bounds;
}
#endif

/// Returns the axis-aligned bounding box of a shape whose frame lies at `pose`.
template <class Real>
inline Aabb<Real> convex_bounds(const Convex<Real>& shape, const Pose<Real>& pose) {
#ifdef PLUMB_BOUNDS_SSE2
  if constexpr (std::is_same_v<Real, float>) {
    if (shape.count == 4) return bounds_of_four(shape, pose);
  }
#endif
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

/// Returns the distance (m) from `point` to the farthest point of the shape, both in the corners' frame.
template <class Real>
inline Real convex_extent(const Convex<Real>& shape, Vec2<Real> point) {
  Real farthest = 0;
  for (int i = 0; i < shape.count; ++i)
    farthest = std::max(farthest, length_squared(shape.corners[i].point - point));
  return std::sqrt(farthest) + shape.radius;
}

/// Returns half the shape's least width, m: a body that moves farther than this in a step may tunnel through
/// something thin. For a segment without radius: 0.
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
