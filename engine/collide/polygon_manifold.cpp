#include "engine/collide/hull_pair.h"

namespace plumb::narrow {

template <class Real>
ContactManifold<Real> collide_polygons(const Convex<Real>& a, const Convex<Real>& b, const Pose<Real>& b_in_a,
                                       Real reach) {
  const Vec2<Real> origin = a.corners[0].point;
  Hull<Real> hull_a, hull_b;
  place(hull_a, a, origin);
  place(hull_b, b, b_in_a.rotation, b_in_a.position - origin);
  return collide_hulls(hull_a, hull_b, smaller_size(a, b), reach, origin, AdmitAll<Real>{});
}

template ContactManifold<float> collide_polygons(const Convex<float>&, const Convex<float>&,
                                                 const Pose<float>&, float);
template ContactManifold<double> collide_polygons(const Convex<double>&, const Convex<double>&,
                                                  const Pose<double>&, double);

}  // namespace plumb::narrow
