#include "engine/collide/hull.h"

namespace plumb::narrow {
template <class Real>
ContactManifold<Real> collide_boxes(const Convex<Real>& a, const Convex<Real>& b, const Pose<Real>& b_in_a,
                                    Real reach) {
  return collide_polygons(a, b, b_in_a, reach);
}
template ContactManifold<float> collide_boxes(const Convex<float>&, const Convex<float>&, const Pose<float>&,
                                              float);
template ContactManifold<double> collide_boxes(const Convex<double>&, const Convex<double>&,
                                               const Pose<double>&, double);
}  // namespace plumb::narrow
