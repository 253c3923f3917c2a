#include "engine/collision/distance/shape_cast.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/collision/distance/hull_distance.h"

namespace plumb {
namespace {

/// Cosine of the angle between a normal and the front of a one-sided line from which the line is not hit.
constexpr double kGrazing = 1e-9;

template <class Real>
CastResult<Real> hit_at(double fraction, bool overlapped, const HullDistance& hulls, Vec2d normal,
                        double radius_a) {
  return {true, overlapped, static_cast<Real>(fraction),
          (hulls.point_a + radius_a * normal).template as<Real>(), normal.template as<Real>()};
}

/// Returns the normal at which a motion enters a from a place where the hulls touch, or zero if it leads
/// along a or away from it. The normals of touching hulls are those along which they are apart, up to
/// `rounding`: one on two flat sides, all those between two edges' normals at a corner, two opposite ones
/// on a line. Each of them must be approached. With a `front` (any length), only normals towards it count:
/// to its other side the line does not exist.
template <class Real>
Vec2d entering_normal(const Convex<Real>& a, const Convex<Real>& b, const Pose<double>& pose, Vec2d nearest,
                      Vec2d displacement, Vec2d front, double rounding) {
  Vec2d best{};
  bool enters = true;
  const bool one_sided = !(front == Vec2d{});
  const auto look = [&](Vec2d normal) {
    if (one_sided && !(dot(front, normal) > kGrazing * std::sqrt(length_squared(front)))) return;
    if (!(separation_along(a, b, pose, normal) >= -rounding)) return;
    const double approach = -dot(normal, displacement);
    enters = enters && approach > 0;
    if (best == Vec2d{} || approach > -dot(best, displacement)) best = normal;
  };
  for (int i = 0; i < a.count && a.count > 1; ++i) look(a.corners[i].normal.template as<double>());
  for (int i = 0; i < b.count && b.count > 1; ++i)
    look(-(pose.rotation * b.corners[i].normal.template as<double>()));
  if (!enters || best == Vec2d{}) return {};
  const bool faces = !one_sided || dot(front, nearest) > kGrazing * std::sqrt(length_squared(front));
  return faces && -dot(nearest, displacement) > 0 ? nearest : best;
}

}  // namespace

// Shapes separated along a normal stay apart at least until the motion along that normal has used up the
// separation. Along the line of nearest points this is Newton's method on the distance, a convex function of
// the displacement, from the near side.
template <class Real>
CastResult<Real> shape_cast(const Convex<Real>& a, const Convex<Real>& b, const Pose<Real>& b_in_a,
                            Vec2<Real> translation, Vec2<Real> front) {
  constexpr double kRounding = 8 * std::numeric_limits<double>::epsilon();
  // The gap falls to a quarter in each iteration even when the shapes graze: 64 iterations reach any
  // rounding.
  constexpr int kMaxIterations = 64;
  const double radius_a = static_cast<double>(a.radius), radius = radius_a + static_cast<double>(b.radius);
  const Vec2d start = b_in_a.position.template as<double>(), displacement = translation.template as<double>();
  const Vec2d facing = front.template as<double>();
  Pose<double> pose{start, {static_cast<double>(b_in_a.rotation.c), static_cast<double>(b_in_a.rotation.s)}};
  const double rounding =
      kRounding * (corner_extent(a) + corner_extent(b) + radius + std::abs(start.x) + std::abs(start.y));

  SimplexCache cache;
  HullDistance hulls = hull_distance(a, b, pose, &cache);
  if (hulls.separation - radius < -rounding) {
    const double size = std::sqrt(length_squared(facing));
    const Vec2d out = size > 0 ? Vec2d{facing.x / size, facing.y / size} : hulls.normal;
    return hit_at<Real>(0, true, hulls, out, radius_a);
  }
  if (hulls.separation <= rounding) {
    const Vec2d normal = entering_normal(a, b, pose, hulls.normal, displacement, facing, rounding);
    return normal == Vec2d{} ? CastResult<Real>{} : hit_at<Real>(0, false, hulls, normal, radius_a);
  }
  double fraction = 0;
  Vec2d last_normal = hulls.normal;
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
    last_normal = hulls.normal;
    pose.position = start + fraction * displacement;
    hulls = hull_distance(a, b, pose, &cache);
  }
  // Hulls that touch have no direction from one to the other: a point on a line may as well come from behind
  // it. The normal of the last step is one: it was approached, and nothing remains of the separation along
  // it.
  const Vec2d normal = hulls.separation <= rounding ? last_normal : hulls.normal;
  if (!(facing == Vec2d{}) && !(dot(facing, normal) > kGrazing * std::sqrt(length_squared(facing))))
    return {};
  return hit_at<Real>(fraction, false, hulls, normal, radius_a);
}

#define PLUMB_INSTANTIATE(Real)                                                                     \
  template CastResult<Real> shape_cast(const Convex<Real>&, const Convex<Real>&, const Pose<Real>&, \
                                       Vec2<Real>, Vec2<Real>);
PLUMB_INSTANTIATE(float)
PLUMB_INSTANTIATE(double)
#undef PLUMB_INSTANTIATE

}  // namespace plumb
