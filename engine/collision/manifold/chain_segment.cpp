#include <cmath>

#include "engine/collision/manifold/chain_neighbour.h"
#include "engine/collision/manifold/hull_pair.h"

namespace plumb {
namespace narrow {
namespace {

/// Admits the normals that belong to a segment: its own, and at an end that bends away from the front those
/// between its own and the neighbour's.
template <class Real>
struct AdmitOwn {
  static constexpr bool kOpen = false;
  Vec2<Real> tangent;
  ChainNeighbour<Real> before, after;
  Real slack;               // m, against rounding: no gap between segments
  Vec2<Real> edge, centre;  // m, the second vertex and the shape's centre, from the first vertex

  Normal operator()(Vec2<Real> normal) const {
    const bool at_first = dot(normal, tangent) < 0;
    const ChainNeighbour<Real>& end = at_first ? before : after;
    if (end.open) return Normal::Admit;
    if (!end.convex) return Normal::Snap;
    if (is_within_bend(end, normal, at_first)) return Normal::Admit;
    return is_nearer(end, at_first) ? Normal::Snap : Normal::Skip;
  }
  // Returns true if the shape's centre is on the segment's side of the bend's bisector. Of a shape that is
  // deeper in than wide neither segment has a normal within the bend; this one then pushes it out.
  bool is_nearer(const ChainNeighbour<Real>& end, bool at_first) const {
    const Vec2<Real> across = tangent + perpendicular(end.normal);
    return at_first ? dot(across, centre) > 0 : dot(across, centre - edge) <= 0;
  }
  void widen(FacingEdges<Real>& edges) const {
    edges.slack_before = before.convex ? Real(0) : slack;
    edges.slack_after = after.convex ? Real(0) : slack;
  }
};

template <class Real>
Real taxicab(Vec2<Real> v) {
  return std::fabs(v.x) + std::fabs(v.y);
}

/// Computes the contact of a disc with the segment, or with a corner between two segments. Both segments at a
/// corner compare the same products, so that exactly one of them gets each disc.
template <class Real>
ContactManifold<Real> collide_segment_disc(const Convex<Real>& segment, Vec2<Real> before, Vec2<Real> after,
                                           Vec2<Real> center, Real radius, Real max_separation) {
  const Vec2<Real> first = segment.corners[0].point, second = segment.corners[1].point;
  const Vec2<Real> normal = segment.corners[0].normal, edge = second - first;
  const Real height = dot(normal, center - first);
  const Real limit = max_separation + segment.radius + radius;
  if (height < 0 || height > limit) return {};
  const bool short_of = dot(center - first, edge)<0, beyond = dot(center - second, edge)> 0;
  if (!short_of && !beyond) {
    const Vec2<Real> foot = center - height * normal;
    return single_point(foot, normal, height, segment.radius, radius, max_separation, 0);
  }
  const Vec2<Real> corner = short_of ? first : second, offset = center - corner;
  // The centre is beside the neighbour, which therefore gets the contact.
  if (short_of && before != first && dot(offset, first - before) <= 0) return {};
  if (beyond && after != second && dot(offset, after - second) >= 0) return {};
  const Real distance = std::sqrt(length_squared(offset));
  if (distance > limit) return {};
  const bool apart = distance * distance > 16 * std::numeric_limits<Real>::min();
  return single_point(corner, apart ? Vec2<Real>{offset.x / distance, offset.y / distance} : normal, distance,
                      segment.radius, radius, max_separation, 0);
}

}  // namespace
}  // namespace narrow

template <class Real>
ContactManifold<Real> collide_chain_segment(const Convex<Real>& segment, Vec2<Real> before, Vec2<Real> after,
                                            const Convex<Real>& b, const Pose<Real>& b_in_a,
                                            Real max_separation, Vec2<Real> pivot) {
  using namespace narrow;
  if (b.count == 1) {
    const Vec2<Real> center = b_in_a.position + b_in_a.rotation * b.corners[0].point;
    return collide_segment_disc(segment, before, after, center, b.radius, max_separation);
  }
  const Vec2<Real> first = segment.corners[0].point, second = segment.corners[1].point;
  const Vec2<Real> normal = segment.corners[0].normal;
  Hull<Real> hull_a, hull_b;
  place<kAny>(hull_a, segment, first);
  hull_a.edges = 1;
  place<kAny>(hull_b, b, b_in_a.rotation, b_in_a.position - first);

  // Only shapes in front are touched.
  Vec2<Real> sum{};
  for (int i = 0; i < hull_b.count; ++i) sum += hull_b.point(i);
  if (dot(normal, sum) < 0) return {};

  const AdmitOwn<Real> admit{perpendicular(normal),
                             chain_neighbour(first, before, normal, true),
                             chain_neighbour(second, after, normal, false),
                             32 * std::numeric_limits<Real>::epsilon() *
                                 (taxicab(first) + taxicab(second) + taxicab(b_in_a.position)),
                             second - first,
                             Real(1) / static_cast<Real>(hull_b.count) * sum};
  return collide_hulls<kAny, kAny>(
      hull_a, hull_b, [&] { return smaller_size(segment, b); }, max_separation, first, pivot - first, admit);
}

template ContactManifold<float> collide_chain_segment(const Convex<float>&, Vec2<float>, Vec2<float>,
                                                      const Convex<float>&, const Pose<float>&, float,
                                                      Vec2<float>);
template ContactManifold<double> collide_chain_segment(const Convex<double>&, Vec2<double>, Vec2<double>,
                                                       const Convex<double>&, const Pose<double>&, double,
                                                       Vec2<double>);

}  // namespace plumb
