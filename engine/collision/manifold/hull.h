#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "engine/collision/manifold/contact_manifold.h"
#include "engine/math/four.h"

/// Shared parts of the collision routines for single pairs of shapes. Not for use outside engine/collision/.
namespace plumb::narrow {

/// Edges at a smaller angle to each other, in rad, count as parallel: either normal is accurate enough, and
/// two points hold better than one.
inline constexpr double kParallel = 2e-3;

/// Additional separation for which an axis of b is preferred over one of a, as a fraction of the smaller
/// shape. A resting face thus keeps its normal while rounding or jitter decides ties.
inline constexpr double kPreference = 5e-4;

/// Corners nearer than this fraction of the smaller shape define no direction: it would be dominated by
/// rounding.
template <class Real>
inline constexpr Real kDirection = std::is_same_v<Real, float> ? Real(1e-4) : Real(1e-9);

/// Feature id of a pair of corners, or of the ends of two edges. It does not depend on the reference face,
/// nor on which of the edges is longer.
constexpr std::uint16_t corner_pair(int of_a, int of_b) {
  return static_cast<std::uint16_t>(of_a << 6 | of_b);
}
static_assert(kMaxCorners <= 64);

/// Returns a length that measures the shape's size and does not depend on its pose.
template <class Real>
Real size_of(const Convex<Real>& shape) {
  const Vec2<Real> across = shape.corners[shape.count / 2].point - shape.corners[0].point;
  return std::fabs(across.x) + std::fabs(across.y) + shape.radius;
}

template <class Real>
constexpr Real smaller(Real a, Real b) {
  return b < a ? b : a;
}
template <class Real>
constexpr Real larger(Real a, Real b) {
  return b > a ? b : a;
}

template <class Real>
Real smaller_size(const Convex<Real>& a, const Convex<Real>& b) {
  return smaller(size_of(a), size_of(b));
}

/// Corners in a common frame whose origin lies near them, so that a shape far from its body's origin loses no
/// digits. Padded to a multiple of four by repeating the last corner.
template <class Real>
struct Hull {
  alignas(16) Real x[kMaxCorners], y[kMaxCorners];    // m
  alignas(16) Real nx[kMaxCorners], ny[kMaxCorners];  // outward normals of the edges that start there
  int count;
  int edges;  // number of edges that can be touched: all of them, or 1 for a chain segment
  Real radius;

  Vec2<Real> point(int i) const { return {x[i], y[i]}; }
  Vec2<Real> normal(int i) const { return {nx[i], ny[i]}; }
  int next(int i) const { return i + 1 < count ? i + 1 : 0; }
  int previous(int i) const { return i > 0 ? i - 1 : count - 1; }
};

/// Compile-time knowledge about a hull's number of corners. kAny: none. kUpToFour: one register of four holds
/// them all, padded. kFour: there are exactly four.
inline constexpr int kAny = 0, kUpToFour = 3, kFour = 4;

/// Loads four corners from `first` on, as x and y of their points and of their normals. `kFull`: all four
/// exist.
template <bool kFull, class Real>
inline void load_corners(const Convex<Real>& shape, int first, Four<Real> (&out)[4]) {
  static_assert(sizeof(Corner<Real>) == 4 * sizeof(Real));
  Four<Real> rows[4];
  for (int i = 0; i < 4; ++i) {
    const int corner = kFull || first + i < shape.count ? first + i : shape.count - 1;
    rows[i] = Four<Real>::load(&shape.corners[corner].point.x);
  }
  transpose(rows, out);
}

/// Places a shape; `kCount` is what is known about its number of corners (kAny, kUpToFour, kFour).
template <int kCount, class Real>
inline void place(Hull<Real>& out, const Convex<Real>& shape, Rotation<Real> rotation, Vec2<Real> position) {
  out.count = out.edges = kCount == kFour ? kFour : shape.count;
  out.radius = shape.radius;
  using Lanes = Four<Real>;
  const Lanes c = Lanes(rotation.c), s = Lanes(rotation.s);
  const Lanes px = Lanes(position.x), py = Lanes(position.y);
  for (int i = 0; i < (kCount == kAny ? shape.count : 4); i += 4) {
    Lanes in[4];
    load_corners<kCount == kFour>(shape, i, in);
    (px + (c * in[0] - s * in[1])).store(out.x + i);
    (py + (s * in[0] + c * in[1])).store(out.y + i);
    (c * in[2] - s * in[3]).store(out.nx + i);
    (s * in[2] + c * in[3]).store(out.ny + i);
  }
}

template <int kCount, class Real>
inline void place(Hull<Real>& out, const Convex<Real>& shape, Vec2<Real> origin) {
  out.count = out.edges = kCount == kFour ? kFour : shape.count;
  out.radius = shape.radius;
  using Lanes = Four<Real>;
  const Lanes px = Lanes(origin.x), py = Lanes(origin.y);
  for (int i = 0; i < (kCount == kAny ? shape.count : 4); i += 4) {
    Lanes in[4];
    load_corners<kCount == kFour>(shape, i, in);
    (in[0] - px).store(out.x + i);
    (in[1] - py).store(out.y + i);
    in[2].store(out.nx + i);
    in[3].store(out.ny + i);
  }
}

/// Two edges that face each other. The reference gives the normal, the incident edge the points.
template <class Real>
struct FacingEdges {
  Vec2<Real> normal{};                     // out of the reference
  Vec2<Real> reference[2], incident[2];    // ends, each in its shape's counter-clockwise order
  int reference_id[2], incident_id[2];     // indices of those corners
  Real reference_radius, incident_radius;  // m
  bool reference_is_b;
  Real slack_before = 0, slack_after = 0;  // m, by which the reference edge is extended beyond its ends
};

/// Returns a manifold of one point, halfway from corner `on_a` (or a point of an edge) along `normal` to the
/// other shape, `distance` away, radii not counted.
template <class Real>
ContactManifold<Real> single_point(Vec2<Real> on_a, Vec2<Real> normal, Real distance, Real radius_a,
                                   Real radius_b, Real max_separation, std::uint16_t feature) {
  ContactManifold<Real> out;
  const Real separation = distance - (radius_a + radius_b);
  if (!(separation <= max_separation)) return out;
  out.normal = normal;
  out.count = 1;
  out.points[0] = {on_a + Real(0.5) * (distance + (radius_a - radius_b)) * normal, separation, feature};
  return out;
}

/// The common part of two facing edges, between two positions along the reference.
template <class Real>
struct Span {
  Real x[2];                            // m, along the reference, from the origin of the edges' frame
  Real gap[2];                          // m, from reference to incident, radii not counted
  Real base[2] = {};                    // m, height of the reference's outline over its edge
  int reference_id[2], incident_id[2];  // outer corner of the outline's edge at each end of the span
  bool overlaps = false;
};

/// Clips the incident edge to the reference edge. Positions along it are relative to the frame's origin,
/// which is near the contact: relative to an end of a long floor, rounding would be proportional to its
/// length.
template <class Real>
inline Span<Real> clip(const FacingEdges<Real>& edges) {
  Span<Real> out;
  const Vec2<Real> tangent = perpendicular(edges.normal);
  const Real first = dot(tangent, edges.reference[0]), last = dot(tangent, edges.reference[1]);
  const Real start_x = dot(tangent, edges.incident[1]), end_x = dot(tangent, edges.incident[0]);
  const Real before = first - edges.slack_before, after = last + edges.slack_after;
  if (end_x < before || start_x > after) return out;
  out.overlaps = true;
  const Real start_y = dot(edges.normal, edges.incident[1] - edges.reference[0]),
             end_y = dot(edges.normal, edges.incident[0] - edges.reference[0]);

  const Real low = start_x < before ? before : start_x, high = end_x > after ? after : end_x;
  const Real width = end_x - start_x;
  // An upright incident edge has both ends over the same place: nothing to clip.
  const Real slope = width > Real(1e-6) * (last - first) ? (end_y - start_y) / width : 0;
  out.x[0] = low, out.x[1] = high;
  out.gap[0] = start_y + slope * (low - start_x), out.gap[1] = end_y - slope * (end_x - high);
  for (int i = 0; i < 2; ++i)
    out.reference_id[i] = edges.reference_id[i], out.incident_id[i] = edges.incident_id[1 - i];
  return out;
}

/// Returns the manifold at the ends of a span that are near enough. `origin` is the origin of the edges'
/// frame in a's frame.
template <class Real>
inline ContactManifold<Real> points_of(const Span<Real>& span, const FacingEdges<Real>& edges,
                                       Real max_separation, Vec2<Real> origin) {
  ContactManifold<Real> out;
  if (!span.overlaps) return out;
  const Vec2<Real> tangent = perpendicular(edges.normal);
  const Real radii = edges.reference_radius + edges.incident_radius;
  const Real lift = edges.reference_radius - edges.incident_radius;
  const Vec2<Real> base = origin + dot(edges.normal, edges.reference[0]) * edges.normal;
  const int reference_shift = edges.reference_is_b ? 0 : 6;  // as in corner_pair
  for (int i = 0; i < 2; ++i) {
    const Real separation = span.gap[i] - radii;
    if (separation > max_separation) continue;
    const Real height = span.base[i] + Real(0.5) * (span.gap[i] + lift);
    out.points[out.count++] = {base + span.x[i] * tangent + height * edges.normal, separation,
                               static_cast<std::uint16_t>(span.reference_id[i] << reference_shift |
                                                          span.incident_id[i] << (6 - reference_shift))};
  }
  out.normal = edges.reference_is_b ? Real(-1) * edges.normal : edges.normal;
  return out;
}

/// Converts a manifold found with the shapes swapped, in the frame of `b`, to a's frame.
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

/// Collides two discs along the line of centres. Coinciding centres give no direction: it uses a's y axis.
template <class Real>
ContactManifold<Real> collide_discs(const Convex<Real>& a, const Convex<Real>& b, const Pose<Real>& b_in_a,
                                    Real max_separation);

/// Collides a hull of two corners or more with a disc.
template <class Real>
ContactManifold<Real> collide_hull_disc(const Convex<Real>& a, const Convex<Real>& b,
                                        const Pose<Real>& b_in_a, Real max_separation);

template <class Real>
ContactManifold<Real> collide_capsules(const Convex<Real>& a, const Convex<Real>& b, const Pose<Real>& b_in_a,
                                       Real max_separation);

/// Collides any two hulls of which one has three corners or more.
template <class Real>
ContactManifold<Real> collide_polygons(const Convex<Real>& a, const Convex<Real>& b, const Pose<Real>& b_in_a,
                                       Real max_separation, Vec2<Real> pivot);

}  // namespace plumb::narrow
