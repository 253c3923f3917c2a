#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "engine/collide/contact_manifold.h"

/// What the collision routines of single pairs of shapes share. Not for use outside engine/collide/.
namespace plumb::narrow {

/// Edges turned by less than this against each other, in rad, count as parallel: whose normal is taken makes
/// no difference of weight, and two points hold better than one.
inline constexpr double kParallel = 2e-3;

/// How much deeper an axis of b must be before it is preferred over one of a, as a share of the smaller
/// shape: what rests on a face keeps to that face's normal while rounding or trembling decides ties.
inline constexpr double kPreference = 5e-4;

/// Corners nearer than this share of the smaller shape give no direction that rounding leaves alone.
template <class Real>
inline constexpr Real kDirection = std::is_same_v<Real, float> ? Real(1e-4) : Real(1e-9);

/// The name of the touching of two corners, or of the ends of two edges. It does not depend on whose face
/// gave the normal, nor on which of the edges is longer.
constexpr std::uint16_t corner_pair(int of_a, int of_b) {
  return static_cast<std::uint16_t>(of_a << 6 | of_b);
}
static_assert(kMaxCorners <= 64);

/// A length that stands for the shape's size: the same in every pose.
template <class Real>
Real size_of(const Convex<Real>& shape) {
  const Vec2<Real> across = shape.corners[shape.count / 2].point - shape.corners[0].point;
  return std::fabs(across.x) + std::fabs(across.y) + shape.radius;
}

template <class Real>
Real smaller_size(const Convex<Real>& a, const Convex<Real>& b) {
  const Real of_a = size_of(a), of_b = size_of(b);
  return of_a < of_b ? of_a : of_b;
}

/// Corners in a common frame whose origin lies near them, so that a shape far from its body's origin loses no
/// digits. Only the first `count` entries are written.
template <class Real>
struct Hull {
  Real x[kMaxCorners], y[kMaxCorners];    // m
  Real nx[kMaxCorners], ny[kMaxCorners];  // outward normals of the edges that start there
  int count;
  int edges;  // the first so many edges can be touched: all of them, or the front of a chain's segment
  Real radius;

  Vec2<Real> point(int i) const { return {x[i], y[i]}; }
  Vec2<Real> normal(int i) const { return {nx[i], ny[i]}; }
  int next(int i) const { return i + 1 < count ? i + 1 : 0; }
  int previous(int i) const { return i > 0 ? i - 1 : count - 1; }
};

template <class Real>
void place(Hull<Real>& out, const Convex<Real>& shape, Rotation<Real> rotation, Vec2<Real> position) {
  out.count = shape.count;
  out.edges = shape.count;
  out.radius = shape.radius;
  for (int i = 0; i < shape.count; ++i) {
    const Vec2<Real> p = position + rotation * shape.corners[i].point, n = rotation * shape.corners[i].normal;
    out.x[i] = p.x, out.y[i] = p.y, out.nx[i] = n.x, out.ny[i] = n.y;
  }
}

template <class Real>
void place(Hull<Real>& out, const Convex<Real>& shape, Vec2<Real> origin) {
  out.count = shape.count;
  out.edges = shape.count;
  out.radius = shape.radius;
  for (int i = 0; i < shape.count; ++i) {
    const Vec2<Real> p = shape.corners[i].point - origin, n = shape.corners[i].normal;
    out.x[i] = p.x, out.y[i] = p.y, out.nx[i] = n.x, out.ny[i] = n.y;
  }
}

/// Two edges that look at each other. The reference gives the normal, the incident edge the points.
template <class Real>
struct FacingEdges {
  Vec2<Real> normal{};                     // out of the reference
  Vec2<Real> reference[2], incident[2];    // ends, each in its shape's counter-clockwise order
  int reference_id[2], incident_id[2];     // indices of those corners
  Real reference_radius, incident_radius;  // m
  bool reference_is_b;
  Real slack_before = 0, slack_after = 0;  // how far beyond its ends the reference edge still counts, m
};

/// One point, on the way from corner `on_a` (or a point of an edge) along `normal` to the other shape, which
/// begins `distance` away, radii not counted.
template <class Real>
ContactManifold<Real> single_point(Vec2<Real> on_a, Vec2<Real> normal, Real distance, Real radius_a,
                                   Real radius_b, Real reach, std::uint16_t feature) {
  ContactManifold<Real> out;
  const Real separation = distance - (radius_a + radius_b);
  if (!(separation <= reach)) return out;
  out.normal = normal;
  out.count = 1;
  out.points[0] = {on_a + Real(0.5) * (distance + (radius_a - radius_b)) * normal, separation, feature};
  return out;
}

/// The part of the incident edge that lies over the reference edge: its two ends, if near enough. `origin` is
/// where the edges' frame begins in a's frame.
template <class Real>
inline ContactManifold<Real> clip(const FacingEdges<Real>& edges, Real reach, Vec2<Real> origin) {
  ContactManifold<Real> out;
  const Vec2<Real> tangent = perpendicular(edges.normal);
  const Real length = dot(tangent, edges.reference[1] - edges.reference[0]);
  const Vec2<Real> start = edges.incident[1] - edges.reference[0],
                   end = edges.incident[0] - edges.reference[0];
  const Real start_x = dot(tangent, start), end_x = dot(tangent, end);
  const Real before = -edges.slack_before, after = length + edges.slack_after;
  if (end_x < before || start_x > after) return out;
  const Real start_y = dot(edges.normal, start), end_y = dot(edges.normal, end);

  const Real low = start_x < before ? before : start_x, high = end_x > after ? after : end_x;
  const Real width = end_x - start_x;
  // An incident edge that stands upright has both ends over the same place: nothing to cut.
  const Real slope = width > Real(1e-6) * length ? (end_y - start_y) / width : 0;
  const Real x[2] = {low, high};
  const Real y[2] = {start_y + slope * (low - start_x), end_y - slope * (end_x - high)};

  const Real radii = edges.reference_radius + edges.incident_radius;
  const Real lift = edges.reference_radius - edges.incident_radius;
  const Vec2<Real> base = origin + edges.reference[0];
  for (int i = 0; i < 2; ++i) {
    const Real separation = y[i] - radii;
    if (separation > reach) continue;
    const int r = edges.reference_id[i], c = edges.incident_id[1 - i];
    out.points[out.count++] = {base + x[i] * tangent + Real(0.5) * (y[i] + lift) * edges.normal, separation,
                               edges.reference_is_b ? corner_pair(c, r) : corner_pair(r, c)};
  }
  out.normal = edges.reference_is_b ? -edges.normal : edges.normal;
  return out;
}

/// A manifold found with the shapes in each other's place, in the frame of `b`, as seen by a.
template <class Real>
ContactManifold<Real> swapped(const ContactManifold<Real>& found, const Pose<Real>& b_in_a) {
  ContactManifold<Real> out;
  out.normal = -(b_in_a.rotation * found.normal);
  out.count = found.count;
  for (int i = 0; i < found.count; ++i) {
    const ContactManifoldPoint<Real>& point = found.points[i];
    out.points[i] = {b_in_a.position + b_in_a.rotation * point.point, point.separation,
                     corner_pair(point.feature & 63, point.feature >> 6)};
  }
  return out;
}

/// Two discs: along the line of centres. Centres that coincide leave the direction open: a's y axis.
template <class Real>
ContactManifold<Real> collide_discs(const Convex<Real>& a, const Convex<Real>& b, const Pose<Real>& b_in_a,
                                    Real reach);

/// A hull of two corners or more against a disc.
template <class Real>
ContactManifold<Real> collide_hull_disc(const Convex<Real>& a, const Convex<Real>& b,
                                        const Pose<Real>& b_in_a, Real reach);

template <class Real>
ContactManifold<Real> collide_capsules(const Convex<Real>& a, const Convex<Real>& b, const Pose<Real>& b_in_a,
                                       Real reach);

/// Two boxes, by four axes; quadrilaterals that are no boxes are left to collide_polygons.
template <class Real>
ContactManifold<Real> collide_boxes(const Convex<Real>& a, const Convex<Real>& b, const Pose<Real>& b_in_a,
                                    Real reach);

/// Any two hulls of which one has three corners or more.
template <class Real>
ContactManifold<Real> collide_polygons(const Convex<Real>& a, const Convex<Real>& b, const Pose<Real>& b_in_a,
                                       Real reach);

}  // namespace plumb::narrow
