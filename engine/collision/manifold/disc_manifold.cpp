#include "engine/collision/manifold/hull.h"

namespace plumb::narrow {
namespace {

/// Returns the manifold of a disc whose centre is `offset` from a point of a's hull. `fallback` is the normal
/// if the two coincide.
template <class Real>
ContactManifold<Real> toward_disc(Vec2<Real> on_a, Vec2<Real> offset, Vec2<Real> fallback, Real radius_a,
                                  Real radius_b, Real max_separation) {
  const Real square = length_squared(offset);
  const Real limit = max_separation + radius_a + radius_b;
  if (square > limit * limit) return {};
  const Real distance = std::sqrt(square);
  const bool apart = square > 16 * std::numeric_limits<Real>::min();
  const Vec2<Real> normal = apart ? Vec2<Real>{offset.x / distance, offset.y / distance} : fallback;
  return single_point(on_a, normal, distance, radius_a, radius_b, max_separation, 0);
}

template <class Real>
ContactManifold<Real> collide_capsule_disc(const Convex<Real>& a, Vec2<Real> center, Real radius,
                                           Real max_separation) {
  const Vec2<Real> first = a.corners[0].point, normal = a.corners[0].normal, tangent = perpendicular(normal);
  const Vec2<Real> offset = center - first;
  const Real length = dot(tangent, a.corners[1].point - first), x = dot(tangent, offset);
  if (x < 0) return toward_disc(first, offset, normal, a.radius, radius, max_separation);
  if (x > length)
    return toward_disc(a.corners[1].point, center - a.corners[1].point, normal, a.radius, radius,
                       max_separation);
  // Beside the axis the normal is the edge's own, without the rounding of a division.
  const Real height = dot(normal, offset);
  const Vec2<Real> side = height < 0 ? -normal : normal;
  return single_point(first + x * tangent, side, std::fabs(height), a.radius, radius, max_separation, 0);
}

template <class Real>
ContactManifold<Real> collide_polygon_disc(const Convex<Real>& a, Vec2<Real> center, Real radius,
                                           Real max_separation) {
  // Finds the edge of greatest separation from the centre. It is the nearest edge if the centre is inside;
  // otherwise it ends at the nearest corner if that is nearer than any edge.
  const Real limit = max_separation + a.radius + radius;
  Real height = -std::numeric_limits<Real>::max();
  int edge = 0;
  for (int i = 0; i < a.count; ++i) {
    const Real out = dot(a.corners[i].normal, center - a.corners[i].point);
    if (out > limit) return {};
    if (out > height) height = out, edge = i;
  }
  const Vec2<Real> normal = a.corners[edge].normal, tangent = perpendicular(normal);
  const Vec2<Real> first = a.corners[edge].point, second = a.corners[edge + 1 < a.count ? edge + 1 : 0].point;
  const Real x = dot(tangent, center - first);
  if (height > 0) {
    if (x < 0) return toward_disc(first, center - first, normal, a.radius, radius, max_separation);
    if (dot(tangent, center - second) > 0)
      return toward_disc(second, center - second, normal, a.radius, radius, max_separation);
  }
  return single_point(first + x * tangent, normal, height, a.radius, radius, max_separation, 0);
}

}  // namespace

template <class Real>
ContactManifold<Real> collide_discs(const Convex<Real>& a, const Convex<Real>& b, const Pose<Real>& b_in_a,
                                    Real max_separation) {
  const Vec2<Real> on_a = a.corners[0].point;
  const Vec2<Real> offset = (b_in_a.position - on_a) + b_in_a.rotation * b.corners[0].point;
  return toward_disc(on_a, offset, {0, 1}, a.radius, b.radius, max_separation);
}

template <class Real>
ContactManifold<Real> collide_hull_disc(const Convex<Real>& a, const Convex<Real>& b,
                                        const Pose<Real>& b_in_a, Real max_separation) {
  const Vec2<Real> center = b_in_a.position + b_in_a.rotation * b.corners[0].point;
  return a.count == 2 ? collide_capsule_disc(a, center, b.radius, max_separation)
                      : collide_polygon_disc(a, center, b.radius, max_separation);
}

#define PLUMB_INSTANTIATE(Real)                                                                             \
  template ContactManifold<Real> collide_discs(const Convex<Real>&, const Convex<Real>&, const Pose<Real>&, \
                                               Real);                                                       \
  template ContactManifold<Real> collide_hull_disc(const Convex<Real>&, const Convex<Real>&,                \
                                                   const Pose<Real>&, Real);
PLUMB_INSTANTIATE(float)
PLUMB_INSTANTIATE(double)
#undef PLUMB_INSTANTIATE

}  // namespace plumb::narrow
