#include <cmath>
#include <utility>

#include "engine/realtime/manifold.h"

namespace plumb {
namespace {

/// The face of one box that faces the other, found by testing the separating axes of that box alone.
template <class Real>
struct Face {
  int axis = 0;         // 0: the box's x, 1: its y
  Real side = 1;        // +1 or -1 along it
  Real separation = 0;  // m
};

/// Returns the face of `box` with the greatest separation from `other`. The greater of both boxes' results is
/// the greatest over all axes.
template <class Real>
Face<Real> best_face(const SolidShape<Real>& box, const Placement<Real>& at, const SolidShape<Real>& other,
                     const Placement<Real>& at_other) {
  const Vec2<Real> between = at.rotation.inverse() * (at_other.center - at.center);
  // The other's half extents projected onto this box's axes.
  const Real c = std::abs(at.rotation.c * at_other.rotation.c + at.rotation.s * at_other.rotation.s);
  const Real s = std::abs(at.rotation.c * at_other.rotation.s - at.rotation.s * at_other.rotation.c);
  const Vec2<Real> seen{c * other.half.x + s * other.half.y, s * other.half.x + c * other.half.y};
  const Real along_x = std::abs(between.x) - (box.half.x + seen.x);
  const Real along_y = std::abs(between.y) - (box.half.y + seen.y);
  if (along_x > along_y) return {0, between.x < 0 ? Real{-1} : Real{1}, along_x};
  return {1, between.y < 0 ? Real{-1} : Real{1}, along_y};
}

/// A corner in the reference box's frame: `along` the face's edge, `out` along its normal from the face.
template <class Real>
struct Corner {
  Real along = 0, out = 0;
  std::uint32_t feature = 0;
};

/// Clips the edge at sign * along = limit. Returns false when nothing is left.
template <class Real>
bool clip(Corner<Real> (&edge)[2], Real sign, Real limit, std::uint32_t mark) {
  const Real beyond[2] = {sign * edge[0].along - limit, sign * edge[1].along - limit};
  if (beyond[0] > 0 && beyond[1] > 0) return false;
  for (int i = 0; i < 2; ++i) {
    if (beyond[i] <= 0) continue;
    const Corner<Real> inside = edge[1 - i];
    const Real share = beyond[1 - i] / (beyond[1 - i] - beyond[i]);
    edge[i].out = inside.out + share * (edge[i].out - inside.out);
    edge[i].along = sign * limit;
    edge[i].feature = (edge[i].feature & ~3u) | mark;
  }
  return true;
}

template <class Real>
Manifold<Real> clip_to_face(const SolidShape<Real>& box, const Placement<Real>& at, const Face<Real>& face,
                            const SolidShape<Real>& other, const Placement<Real>& at_other, Real reach) {
  // The reference frame: `normal` out of the face, `edge` along it.
  const Vec2<Real> axis{at.rotation.c, at.rotation.s};
  const Vec2<Real> normal = face.side * (face.axis == 0 ? axis : perpendicular(axis));
  const Vec2<Real> edge = perpendicular(normal);
  const Real half_out = face.axis == 0 ? box.half.x : box.half.y;
  const Real half_along = face.axis == 0 ? box.half.y : box.half.x;

  // The other's edge that faces most directly against the normal.
  const Vec2<Real> n = at_other.rotation.inverse() * normal;
  const int other_axis = std::abs(n.x) > std::abs(n.y) ? 0 : 1;
  const Real other_side = (other_axis == 0 ? n.x : n.y) > 0 ? Real{-1} : Real{1};
  Corner<Real> corners[2];
  const std::uint32_t face_id = (face.axis == 0 ? 0u : 1u) | (face.side > 0 ? 2u : 0u);
  const std::uint32_t other_id = (other_axis == 0 ? 0u : 1u) | (other_side > 0 ? 2u : 0u);
  for (int i = 0; i < 2; ++i) {
    const Real end = i == 0 ? Real{-1} : Real{1};
    const Vec2<Real> local = other_axis == 0 ? Vec2<Real>{other_side * other.half.x, end * other.half.y}
                                             : Vec2<Real>{end * other.half.x, other_side * other.half.y};
    const Vec2<Real> from_center = (at_other.center - at.center) + at_other.rotation * local;
    corners[i] = {dot(from_center, edge), dot(from_center, normal) - half_out,
                  face_id << 5 | other_id << 3 | static_cast<std::uint32_t>(i)};
  }

  Manifold<Real> out;
  out.normal = normal;
  if (!clip(corners, Real{1}, half_along, 2u) || !clip(corners, Real{-1}, half_along, 3u)) return out;
  for (const Corner<Real>& corner : corners) {
    if (corner.out > reach) continue;
    const Vec2<Real> on_face = at.center + (half_out * normal + corner.along * edge);
    out.points[out.count++] = {on_face, on_face + corner.out * normal, corner.out, corner.feature};
  }
  return out;
}

}  // namespace

template <class Real>
Manifold<Real> collide_boxes(const SolidShape<Real>& a, const Placement<Real>& at_a,
                             const SolidShape<Real>& b, const Placement<Real>& at_b, Real reach) {
  const Face<Real> of_a = best_face(a, at_a, b, at_b);
  const Face<Real> of_b = best_face(b, at_b, a, at_a);
  if (of_a.separation > reach || of_b.separation > reach) return {};
  // Prefer a's face among nearly parallel ones: b must win clearly, so that rounding does not swap them.
  constexpr Real kPreference = Real(1e-3);
  const Real clearly = kPreference * std::fmin(std::fmin(a.half.x, a.half.y), std::fmin(b.half.x, b.half.y));
  if (of_b.separation <= of_a.separation + clearly) return clip_to_face(a, at_a, of_a, b, at_b, reach);

  Manifold<Real> out = clip_to_face(b, at_b, of_b, a, at_a, reach);
  out.reference_is_b = true;
  out.normal = -out.normal;
  for (ManifoldPoint<Real>& point : out.points) {
    std::swap(point.on_a, point.on_b);
    point.feature |= 1u << 8;
  }
  return out;
}

template Manifold<float> collide_boxes(const SolidShape<float>&, const Placement<float>&,
                                       const SolidShape<float>&, const Placement<float>&, float);
template Manifold<double> collide_boxes(const SolidShape<double>&, const Placement<double>&,
                                        const SolidShape<double>&, const Placement<double>&, double);

}  // namespace plumb
