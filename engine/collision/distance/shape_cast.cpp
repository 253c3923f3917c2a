#include "engine/collision/distance/shape_cast.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/collision/distance/hull_distance.h"

namespace plumb {
namespace {

template <class Real>
CastResult<Real> hit_at(double fraction, bool overlapped, const HullDistance& hulls, double radius_a) {
  return {true, overlapped, static_cast<Real>(fraction),
          (hulls.point_a + radius_a * hulls.normal).template as<Real>(), hulls.normal.template as<Real>()};
}

}  // namespace

// Shapes separated along a normal stay apart at least until the motion along that normal has used up the
// separation. Along the line of nearest points this is Newton's method on the distance, a convex function of
// the displacement, from the near side.
template <class Real>
CastResult<Real> shape_cast(const Convex<Real>& a, const Convex<Real>& b, const Pose<Real>& b_in_a,
                            Vec2<Real> translation) {
  constexpr double kRounding = 8 * std::numeric_limits<double>::epsilon();
  // The gap falls to a quarter in each iteration even when the shapes graze: 64 iterations reach any
  // rounding.
  constexpr int kMaxIterations = 64;
  const double radius_a = static_cast<double>(a.radius), radius = radius_a + static_cast<double>(b.radius);
  const Vec2d start = b_in_a.position.template as<double>(), displacement = translation.template as<double>();
  Pose<double> pose{start, {static_cast<double>(b_in_a.rotation.c), static_cast<double>(b_in_a.rotation.s)}};
  const double rounding =
      kRounding * (corner_extent(a) + corner_extent(b) + radius + std::abs(start.x) + std::abs(start.y));

  SimplexCache cache;
  HullDistance hulls = hull_distance(a, b, pose, &cache);
  if (hulls.separation - radius < -rounding) return hit_at<Real>(0, true, hulls, radius_a);
  double fraction = 0;
  for (int iteration = 0;; ++iteration) {
    const bool touching = hulls.separation - radius <= rounding;
    const double gap = touching ? 0 : separation_along(a, b, pose, hulls.normal) - radius;
    const double approach = -dot(hulls.normal, displacement);
    // A normal along which the shapes do not approach keeps them apart for the rest of the motion.
    if (!(approach > 0) && (gap > 0 || !(fraction > 0))) return {};
    if (!(gap > 0) || iteration == kMaxIterations) break;
    const double next = fraction + gap / approach;
    if (next > 1) return {};
    if (next <= fraction) break;
    fraction = next;
    pose.position = start + fraction * displacement;
    hulls = hull_distance(a, b, pose, &cache);
  }
  return hit_at<Real>(fraction, false, hulls, radius_a);
}

#define PLUMB_INSTANTIATE(Real)                                                                     \
  template CastResult<Real> shape_cast(const Convex<Real>&, const Convex<Real>&, const Pose<Real>&, \
                                       Vec2<Real>);
PLUMB_INSTANTIATE(float)
PLUMB_INSTANTIATE(double)
#undef PLUMB_INSTANTIATE

}  // namespace plumb
