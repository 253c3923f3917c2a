#include "engine/collision/manifold/contact_manifold.h"

#include "engine/collision/manifold/hull.h"

namespace plumb {

template <class Real>
ContactManifold<Real> collide_convex(const Convex<Real>& a, const Convex<Real>& b, const Pose<Real>& b_in_a,
                                     Real max_separation, Vec2<Real> pivot) {
  if (a.count == 4 && b.count == 4) return narrow::collide_polygons(a, b, b_in_a, max_separation, pivot);
  if (b.count == 1) {
    if (a.count == 1) return narrow::collide_discs(a, b, b_in_a, max_separation);
    return narrow::collide_hull_disc(a, b, b_in_a, max_separation);
  }
  if (a.count == 1) {
    const Rotation<Real> back = b_in_a.rotation.inverse();
    const Pose<Real> a_in_b{-(back * b_in_a.position), back};
    return narrow::swapped(narrow::collide_hull_disc(b, a, a_in_b, max_separation), b_in_a);
  }
  if (a.count == 2 && b.count == 2) return narrow::collide_capsules(a, b, b_in_a, max_separation);
  return narrow::collide_polygons(a, b, b_in_a, max_separation, pivot);
}

template ContactManifold<float> collide_convex(const Convex<float>&, const Convex<float>&, const Pose<float>&,
                                               float, Vec2<float>);
template ContactManifold<double> collide_convex(const Convex<double>&, const Convex<double>&,
                                                const Pose<double>&, double, Vec2<double>);

}  // namespace plumb
