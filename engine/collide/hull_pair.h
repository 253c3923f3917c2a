#pragma once

#include <cstdint>

#include "engine/collide/hull.h"

namespace plumb::narrow {

/// What a segment of a chain does with a normal.
enum class Normal : std::uint8_t {
  Admit,  ///< it is one of the segment's own
  Snap,   ///< the surface goes on smoothly or hollow there: the segment's own normal instead
  Skip,   ///< it belongs to a neighbour
};

/// For shapes without neighbours.
template <class Real>
struct AdmitAll {
  static constexpr bool kOpen = true;  // a touching that no two edges share is one nevertheless
  Normal operator()(Vec2<Real>) const { return Normal::Admit; }
  void widen(FacingEdges<Real>&) const {}
};

/// The edge of one hull that another is farthest out of, and the corner of the other that is least so.
template <class Real>
struct Face {
  Real separation;  // m, radii not counted
  int edge, corner;
};

/// Over all edges that can be touched; stops at one beyond `limit`.
template <class Real>
Face<Real> farthest_face(const Hull<Real>& hull, const Hull<Real>& other, Real limit) {
  Face<Real> best{-std::numeric_limits<Real>::max(), 0, 0};
  for (int i = 0; i < hull.edges; ++i) {
    const Real nx = hull.nx[i], ny = hull.ny[i];
    Real least = nx * other.x[0] + ny * other.y[0];
    for (int j = 1; j < other.count; ++j) {
      const Real out = nx * other.x[j] + ny * other.y[j];
      least = out < least ? out : least;
    }
    const Real separation = least - (nx * hull.x[i] + ny * hull.y[i]);
    if (separation > best.separation) {
      best.separation = separation, best.edge = i;
      if (separation > limit) return best;
    }
  }
  const Vec2<Real> normal = hull.normal(best.edge);
  Real least = dot(normal, other.point(0));
  for (int j = 1; j < other.count; ++j)
    if (const Real out = dot(normal, other.point(j)); out < least) least = out, best.corner = j;
  return best;
}

/// Where a point lies along an edge: -1 before its first corner, 1 beyond its second, 0 between.
template <class Real>
int along(const Hull<Real>& hull, int edge, Vec2<Real> point) {
  const Vec2<Real> tangent = perpendicular(hull.normal(edge));
  if (dot(tangent, point - hull.point(edge)) < 0) return -1;
  return dot(tangent, point - hull.point(hull.next(edge))) > 0 ? 1 : 0;
}

/// The edge of `other` at `corner` that looks most directly against `normal`.
template <class Real>
int facing_edge(const Hull<Real>& other, int corner, Vec2<Real> normal) {
  const int before = other.previous(corner);
  return dot(other.normal(before), normal) < dot(other.normal(corner), normal) ? before : corner;
}

template <class Real>
FacingEdges<Real> facing_edges(const Hull<Real>& reference, const Face<Real>& face, const Hull<Real>& other,
                               bool reference_is_b) {
  const int end = reference.next(face.edge);
  const int incident = facing_edge(other, face.corner, reference.normal(face.edge));
  const int incident_end = other.next(incident);
  FacingEdges<Real> out;
  out.normal = reference.normal(face.edge);
  out.reference[0] = reference.point(face.edge), out.reference[1] = reference.point(end);
  out.incident[0] = other.point(incident), out.incident[1] = other.point(incident_end);
  out.reference_id[0] = face.edge, out.reference_id[1] = end;
  out.incident_id[0] = incident, out.incident_id[1] = incident_end;
  out.reference_radius = reference.radius, out.incident_radius = other.radius;
  out.reference_is_b = reference_is_b;
  return out;
}

/// Whether the edges are parallel and one lies over the other: they touch along their length.
template <class Real>
bool flush(const FacingEdges<Real>& edges) {
  const Vec2<Real> tangent = perpendicular(edges.normal);
  const Vec2<Real> start = edges.incident[1] - edges.reference[0],
                   end = edges.incident[0] - edges.reference[0];
  const Vec2<Real> way = end - start;
  const Real rise = dot(edges.normal, way), run = dot(tangent, way);
  return std::fabs(rise) < Real(kParallel) * run && dot(tangent, end) > 0 &&
         dot(tangent, start) < dot(tangent, edges.reference[1] - edges.reference[0]);
}

/// What touches first when two hulls are apart.
enum class Feature : std::uint8_t { FaceOfA, FaceOfB, Corners };

template <class Real>
struct Nearest {
  Feature feature;
  int corner_a, corner_b;  // when it is two corners
};

/// The separation along a normal is the distance times the cosine of the angle to the nearest direction,
/// while the same corners stay in support: so the face with the greatest separation ends at, or is, the
/// nearest feature of its hull.
template <class Real>
Nearest<Real> nearest_apart(const Hull<Real>& a, const Face<Real>& of_a, const Hull<Real>& b,
                            const Face<Real>& of_b, bool prefer_b, bool is_flush) {
  const Feature preferred = prefer_b ? Feature::FaceOfB : Feature::FaceOfA;
  const int place_on_a = along(a, of_a.edge, b.point(of_a.corner));
  const int place_on_b = along(b, of_b.edge, a.point(of_b.corner));
  if (is_flush || (prefer_b ? place_on_b : place_on_a) == 0) return {preferred, 0, 0};
  if (of_b.separation > of_a.separation) {
    if (place_on_b == 0) return {Feature::FaceOfB, 0, 0};
    return {Feature::Corners, of_b.corner, place_on_b < 0 ? of_b.edge : b.next(of_b.edge)};
  }
  if (place_on_a == 0) return {Feature::FaceOfA, 0, 0};
  return {Feature::Corners, place_on_a < 0 ? of_a.edge : a.next(of_a.edge), of_a.corner};
}

/// The manifold of two hulls in one frame, whose origin lies at `origin` in a's frame. `size` is that of the
/// smaller one. `admit` says which normals may be used; what it snaps gets that of a's first edge.
template <class Real, class Admit>
ContactManifold<Real> collide_hulls(const Hull<Real>& a, const Hull<Real>& b, Real size, Real reach,
                                    Vec2<Real> origin, const Admit& admit) {
  const Real limit = reach + a.radius + b.radius;
  const Face<Real> of_a = farthest_face(a, b, limit);
  if (of_a.separation > limit) return {};
  const Face<Real> of_b = farthest_face(b, a, limit);
  if (of_b.separation > limit) return {};

  const bool prefer_b = of_b.separation > of_a.separation + Real(kPreference) * size;
  FacingEdges<Real> edges = prefer_b ? facing_edges(b, of_b, a, true) : facing_edges(a, of_a, b, false);
  Nearest<Real> nearest{prefer_b ? Feature::FaceOfB : Feature::FaceOfA, 0, 0};
  if (of_a.separation > 0 || of_b.separation > 0)
    nearest = nearest_apart(a, of_a, b, of_b, prefer_b, flush(edges));

  if (nearest.feature == Feature::Corners) {
    const Vec2<Real> on_a = a.point(nearest.corner_a), way = b.point(nearest.corner_b) - on_a;
    const Real distance = std::sqrt(length_squared(way));
    if (distance > kDirection<Real> * size) {
      const Vec2<Real> normal{way.x / distance, way.y / distance};
      const Normal answer = admit(normal);
      if (answer == Normal::Skip) return {};
      if (answer == Normal::Admit)
        return single_point(origin + on_a, normal, distance, a.radius, b.radius, reach,
                            corner_pair(nearest.corner_a, nearest.corner_b));
      nearest.feature = Feature::FaceOfA;
    } else {
      nearest.feature = prefer_b ? Feature::FaceOfB : Feature::FaceOfA;
    }
  }
  if (nearest.feature == Feature::FaceOfB) {
    const Normal answer = admit(-b.normal(of_b.edge));
    if (answer == Normal::Skip) return {};
    if (answer == Normal::Snap) nearest.feature = Feature::FaceOfA;
  }

  const bool reference_is_b = nearest.feature == Feature::FaceOfB;
  if (reference_is_b != prefer_b)
    edges = reference_is_b ? facing_edges(b, of_b, a, true) : facing_edges(a, of_a, b, false);
  if (!reference_is_b) admit.widen(edges);
  const ContactManifold<Real> out = clip(edges, reach, origin);
  if (out.count > 0 || !Admit::kOpen) return out;
  // Edges that miss each other by a rounding or by the preference: the deepest corner alone.
  const Face<Real>& face = reference_is_b ? of_b : of_a;
  const Vec2<Real> corner = reference_is_b ? a.point(face.corner) : b.point(face.corner);
  const int first = face.edge, second = reference_is_b ? b.next(first) : a.next(first);
  const bool at_first = along(reference_is_b ? b : a, face.edge, corner) < 0;
  const int other = at_first ? first : second;
  if (reference_is_b) {
    const Vec2<Real> normal = -b.normal(face.edge);
    return single_point(origin + corner, normal, face.separation, a.radius, b.radius, reach,
                        corner_pair(face.corner, other));
  }
  const Vec2<Real> normal = a.normal(face.edge);
  return single_point(origin + corner - face.separation * normal, normal, face.separation, a.radius, b.radius,
                      reach, corner_pair(other, face.corner));
}

}  // namespace plumb::narrow
