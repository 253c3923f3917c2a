#include "engine/collision/manifold/hull_pair.h"

namespace plumb::narrow {

namespace {

/// `kA` and `kB` are what is known at compile time about the numbers of corners.
template <int kA, int kB, class Real>
ContactManifold<Real> collide_counted(const Convex<Real>& a, const Convex<Real>& b, const Pose<Real>& b_in_a,
                                      Real max_separation, Vec2<Real> pivot) {
  // Coordinates are relative to the centre that is nearer to the pivot. Relative to a corner of a long floor,
  // their rounding would be proportional to the floor's length. The pivot itself is no better: sums with it
  // round, sums with a centre are exact.
  const bool near_b = length_squared(pivot) > length_squared(pivot - b_in_a.position);
  const Vec2<Real> origin = near_b ? b_in_a.position : Vec2<Real>{};
  Hull<Real> hull_a, hull_b;
  place<kA>(hull_a, a, origin);
  place<kB>(hull_b, b, b_in_a.rotation, b_in_a.position - origin);
  return collide_hulls<kA, kB>(
      hull_a, hull_b, [&] { return smaller_size(a, b); }, max_separation, origin, pivot - origin,
      AdmitAll<Real>{});
}

}  // namespace

template <class Real>
ContactManifold<Real> collide_polygons(const Convex<Real>& a, const Convex<Real>& b, const Pose<Real>& b_in_a,
                                       Real max_separation, Vec2<Real> pivot) {
  // Boxes are the most common shapes.
  if (a.count == 4 && b.count == 4) return collide_counted<kFour, kFour>(a, b, b_in_a, max_separation, pivot);
  if (a.count <= 4 && b.count <= 4)
    return collide_counted<kUpToFour, kUpToFour>(a, b, b_in_a, max_separation, pivot);
  return collide_counted<kAny, kAny>(a, b, b_in_a, max_separation, pivot);
}

template ContactManifold<float> collide_polygons(const Convex<float>&, const Convex<float>&,
                                                 const Pose<float>&, float, Vec2<float>);
template ContactManifold<double> collide_polygons(const Convex<double>&, const Convex<double>&,
                                                  const Pose<double>&, double, Vec2<double>);

}  // namespace plumb::narrow
