#include "engine/collision/manifold/hull.h"

namespace plumb::narrow {
namespace {

/// A capsule's axis.
template <class Real>
struct Axis {
  Vec2<Real> ends[2];
  Vec2<Real> normal;  // to the right of the direction from the first end to the second
  Real length;
};

/// An end of one axis relative to the other one.
template <class Real>
struct End {
  Real along, height;  // m, from the other's first end: along the axis, and along its normal
  Real square;         // m^2, of the distance
};

template <class Real>
End<Real> locate(const Axis<Real>& from, Vec2<Real> point) {
  const Vec2<Real> offset = point - from.ends[0];
  const Real along = dot(perpendicular(from.normal), offset), height = dot(from.normal, offset);
  const Real beyond = along < 0 ? along : along > from.length ? along - from.length : 0;
  return {along, height, beyond * beyond + height * height};
}

template <class Real>
bool projects_onto(const Axis<Real>& axis, const End<Real>& end) {
  return end.along >= 0 && end.along <= axis.length;
}

/// The side of an axis on which its two ends penetrate less, and the separation of the deeper end on that
/// side.
template <class Real>
struct Side {
  bool right;       // of the axis: along its normal
  Real separation;  // m
};

template <class Real>
Side<Real> shallow_side(const End<Real> (&ends)[2]) {
  const Real least = ends[0].height < ends[1].height ? ends[0].height : ends[1].height;
  const Real most = ends[0].height < ends[1].height ? ends[1].height : ends[0].height;
  return {least >= -most, least >= -most ? least : -most};
}

template <class Real>
ContactManifold<Real> clip_axes(const Axis<Real>& reference, bool right, const Axis<Real>& other,
                                bool reference_is_b, Real reference_radius, Real other_radius,
                                Real max_separation, Vec2<Real> origin) {
  const int r = right ? 0 : 1;
  FacingEdges<Real> edges;
  edges.normal = right ? reference.normal : -reference.normal;
  // The other's edge that faces the reference: its right side when its normal points against the reference's.
  const int i = dot(edges.normal, other.normal) <= 0 ? 0 : 1;
  for (int end = 0; end < 2; ++end) {
    edges.reference_id[end] = end ^ r, edges.incident_id[end] = end ^ i;
    edges.reference[end] = reference.ends[end ^ r], edges.incident[end] = other.ends[end ^ i];
  }
  edges.reference_radius = reference_radius, edges.incident_radius = other_radius;
  edges.reference_is_b = reference_is_b;
  return points_of(clip(edges), edges, max_separation, origin);
}

}  // namespace

template <class Real>
ContactManifold<Real> collide_capsules(const Convex<Real>& a, const Convex<Real>& b, const Pose<Real>& b_in_a,
                                       Real max_separation) {
  const Vec2<Real> origin = a.corners[0].point, offset = b_in_a.position - origin;
  const Rotation<Real> q = b_in_a.rotation;
  Axis<Real> p{{{0, 0}, a.corners[1].point - origin}, a.corners[0].normal, 0};
  Axis<Real> s{
      {offset + q * b.corners[0].point, offset + q * b.corners[1].point}, q * b.corners[0].normal, 0};
  p.length = dot(perpendicular(p.normal), p.ends[1]);
  s.length = dot(perpendicular(s.normal), s.ends[1] - s.ends[0]);

  // Unless they cross, two segments are nearest at an end of one.
  const End<Real> of_b[2] = {locate(p, s.ends[0]), locate(p, s.ends[1])};  // seen from a
  const End<Real> of_a[2] = {locate(s, p.ends[0]), locate(s, p.ends[1])};
  const int nearest_b = of_b[1].square < of_b[0].square ? 1 : 0;
  const int nearest_a = of_a[1].square < of_a[0].square ? 1 : 0;
  const Real square =
      of_a[nearest_a].square < of_b[nearest_b].square ? of_a[nearest_a].square : of_b[nearest_b].square;
  const Real limit = max_separation + a.radius + b.radius;
  const Real rounding = kDirection<Real> * smaller_size(a, b);
  const auto opposite = [](const End<Real>(&ends)[2]) {
    return (ends[0].height < 0) != (ends[1].height < 0);
  };
  const bool crossing = opposite(of_b) && opposite(of_a);
  if (!crossing && square > limit * limit) return {};

  bool use_b = false, right = true;
  if (crossing || square <= rounding * rounding) {
    const Side<Real> on_a = shallow_side(of_b), on_b = shallow_side(of_a);
    use_b = on_b.separation > on_a.separation + Real(kPreference) * smaller_size(a, b);
    right = use_b ? on_b.right : on_a.right;
  } else {
    const bool parallel = std::fabs(cross(p.normal, s.normal)) < Real(kParallel);
    const bool overlap =
        (of_b[0].along > 0 || of_b[1].along > 0) && (of_b[0].along < p.length || of_b[1].along < p.length);
    use_b = of_a[nearest_a].square < of_b[nearest_b].square && !(parallel && overlap);
    const bool face = use_b ? projects_onto(s, of_a[nearest_a])
                            : projects_onto(p, of_b[nearest_b]) || (parallel && overlap);
    if (!face) {
      const int end_a = use_b ? nearest_a : (of_b[nearest_b].along < 0 ? 0 : 1);
      const int end_b = use_b ? (of_a[nearest_a].along < 0 ? 0 : 1) : nearest_b;
      const Vec2<Real> between = s.ends[end_b] - p.ends[end_a];
      const Real distance = std::sqrt(length_squared(between));
      return single_point(origin + p.ends[end_a], {between.x / distance, between.y / distance}, distance,
                          a.radius, b.radius, max_separation, corner_pair(end_a, end_b));
    }
    right = (use_b ? of_a[nearest_a].height : of_b[nearest_b].height) >= 0;
  }
  const ContactManifold<Real> out =
      use_b ? clip_axes(s, right, p, true, b.radius, a.radius, max_separation, origin)
            : clip_axes(p, right, s, false, a.radius, b.radius, max_separation, origin);
  if (out.count > 0 || square > rounding * rounding) return out;
  // Collinear axes, end to end: by rounding, the clipped axes have no common part. Use the two facing ends.
  const int end_a = of_b[nearest_b].along < p.length / 2 ? 0 : 1;
  return single_point(origin + p.ends[end_a], right ? p.normal : -p.normal, Real(0), a.radius, b.radius,
                      max_separation, corner_pair(end_a, nearest_b));
}

template ContactManifold<float> collide_capsules(const Convex<float>&, const Convex<float>&,
                                                 const Pose<float>&, float);
template ContactManifold<double> collide_capsules(const Convex<double>&, const Convex<double>&,
                                                  const Pose<double>&, double);

}  // namespace plumb::narrow
