#include "engine/collision/distance/distance.h"

namespace plumb {

template <class Real>
DistanceResult<Real> distance(const Convex<Real>& a, const Convex<Real>& b, const Pose<Real>& b_in_a,
                              SimplexCache* cache) {
  const Pose<double> pose{b_in_a.position.template as<double>(),
                          {static_cast<double>(b_in_a.rotation.c), static_cast<double>(b_in_a.rotation.s)}};
  const HullDistance hulls = hull_distance(a, b, pose, cache);
  const double radius_a = static_cast<double>(a.radius), radius_b = static_cast<double>(b.radius);
  const double gap = hulls.separation - (radius_a + radius_b);
  return {(hulls.point_a + radius_a * hulls.normal).template as<Real>(),
          (hulls.point_b - radius_b * hulls.normal).template as<Real>(), hulls.normal.template as<Real>(),
          gap > 0 ? static_cast<Real>(gap) : Real{0}, hulls.iterations};
}

#define PLUMB_INSTANTIATE(Real)                                                                       \
  template DistanceResult<Real> distance(const Convex<Real>&, const Convex<Real>&, const Pose<Real>&, \
                                         SimplexCache*);
PLUMB_INSTANTIATE(float)
PLUMB_INSTANTIATE(double)
#undef PLUMB_INSTANTIATE

}  // namespace plumb
