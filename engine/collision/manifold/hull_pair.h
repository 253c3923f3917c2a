#pragma once

#include <cmath>
#include <cstdint>

#include "engine/collision/manifold/hull.h"

namespace plumb::narrow {

/// How a chain segment treats a contact normal.
enum class Normal : std::uint8_t {
  Admit,  ///< the normal is one of the segment's own
  Snap,   ///< the surface is smooth or concave there: use the segment's own normal instead
  Skip,   ///< the normal belongs to a neighbour
};

/// Accepts every normal: for shapes without neighbours.
template <class Real>
struct AdmitAll {
  static constexpr bool kOpen = true;  // a contact at a corner alone counts
  Normal operator()(Vec2<Real>) const { return Normal::Admit; }
  void widen(FacingEdges<Real>&) const {}
};

/// The edge of one hull that is farthest from another.
template <class Real>
struct Face {
  Real separation;  // m, radii not counted
  int edge;
};

/// Evaluates four edges at once, and reduces them in pairs to the farthest: the first of equals.
template <class Real>
inline Face<Real> farthest_of_four(const Hull<Real>& hull, int first, const Hull<Real>& other, int count) {
  using Lanes = Four<Real>;
  const Lanes nx = Lanes::load(hull.nx + first), ny = Lanes::load(hull.ny + first);
  Lanes out = nx * Lanes(other.x[0]) + ny * Lanes(other.y[0]);
  for (int j = 1; j < count; ++j) out = min(out, nx * Lanes(other.x[j]) + ny * Lanes(other.y[j]));
  out = out - (nx * Lanes::load(hull.x + first) + ny * Lanes::load(hull.y + first));
  Real s[4];
  out.store(s);
  const Real most_low = larger(s[0], s[1]), most_high = larger(s[2], s[3]);
  const int low = s[1] > s[0], high = 2 + (s[3] > s[2]);
  return {larger(most_low, most_high), first + (most_high > most_low ? high : low)};
}

/// Searches all edges that can be touched; stops at one beyond `limit`. The template arguments are what is
/// known about the numbers of corners. Padding repeats the last corner, and never wins over the corner
/// itself.
template <int kCount, int kOther, class Real>
inline Face<Real> farthest_face(const Hull<Real>& hull, const Hull<Real>& other, Real limit) {
  const int count = kOther == kAny ? other.count : 4;
  if (kCount == kAny && hull.edges == 1) {  // a chain's front
    Real out = dot(hull.normal(0), other.point(0));
    for (int j = 1; j < count; ++j)
      if (const Real next = dot(hull.normal(0), other.point(j)); next < out) out = next;
    return {out - dot(hull.normal(0), hull.point(0)), 0};
  }
  Face<Real> best = farthest_of_four(hull, 0, other, count);
  if (kCount != kAny) return best;
  for (int i = 4; i < hull.count && best.separation <= limit; i += 4)
    if (const Face<Real> face = farthest_of_four(hull, i, other, count); face.separation > best.separation)
      best = face;
  return best;
}

/// Returns the corner with the smallest coordinate along a direction: the first of equals.
template <int kCount, class Real>
inline int support(const Hull<Real>& hull, Vec2<Real> direction) {
  if (kCount != kAny) {
    using Lanes = Four<Real>;
    Real s[4];
    (Lanes(direction.x) * Lanes::load(hull.x) + Lanes(direction.y) * Lanes::load(hull.y)).store(s);
    const Real least_low = smaller(s[0], s[1]), least_high = smaller(s[2], s[3]);
    const int low = s[1] < s[0], high = 2 + (s[3] < s[2]);
    return least_high < least_low ? high : low;
  }
  int corner = 0;
  Real out = dot(direction, hull.point(0));
  for (int j = 1; j < hull.count; ++j)
    if (const Real next = dot(direction, hull.point(j)); next < out) out = next, corner = j;
  return corner;
}

/// Classifies a point along an edge: -1 before its first corner, 1 beyond its second, 0 between.
template <class Real>
int along(const Hull<Real>& hull, int edge, Vec2<Real> point) {
  const Vec2<Real> tangent = perpendicular(hull.normal(edge));
  if (dot(tangent, point - hull.point(edge)) < 0) return -1;
  return dot(tangent, point - hull.point(hull.next(edge))) > 0 ? 1 : 0;
}

/// Returns which of the two edges of `other` at `corner`, its corner nearest along `normal`, rises less.
/// Compares sines: the cosines of small angles are all 1 to rounding. Both edges of a segment rise equally;
/// one faces `normal`.
template <class Real>
int facing_edge(const Hull<Real>& other, int corner, Vec2<Real> normal) {
  const int before = other.previous(corner);
  const Vec2<Real> n_before = other.normal(before), n_after = other.normal(corner);
  if (other.count == 2) return dot(n_before, normal) < dot(n_after, normal) ? before : corner;
  return cross(normal, n_before) < cross(n_after, normal) ? before : corner;
}

/// `kOther` is what is known at compile time about the number of corners of `other`.
template <int kOther, class Real>
inline FacingEdges<Real> facing_edges(const Hull<Real>& reference, int edge, const Hull<Real>& other,
                                      bool reference_is_b) {
  FacingEdges<Real> out;
  out.normal = reference.normal(edge);
  const int end = reference.next(edge);
  const int incident = facing_edge(other, support<kOther>(other, out.normal), out.normal);
  const int incident_end = other.next(incident);
  out.reference[0] = reference.point(edge), out.reference[1] = reference.point(end);
  out.incident[0] = other.point(incident), out.incident[1] = other.point(incident_end);
  out.reference_id[0] = edge, out.reference_id[1] = end;
  out.incident_id[0] = incident, out.incident_id[1] = incident_end;
  out.reference_radius = reference.radius, out.incident_radius = other.radius;
  out.reference_is_b = reference_is_b;
  return out;
}

/// Returns true if separated hulls may use the reference edge's normal: the nearest corner lies over the
/// edge, or the edges are parallel and overlap along their length.
template <class Real>
inline bool over_edge(const FacingEdges<Real>& edges) {
  const Vec2<Real> tangent = perpendicular(edges.normal);
  const Vec2<Real> start = edges.incident[1] - edges.reference[0],
                   end = edges.incident[0] - edges.reference[0];
  const Real rise = dot(edges.normal, end - start), start_x = dot(tangent, start), end_x = dot(tangent, end);
  const Real length = dot(tangent, edges.reference[1] - edges.reference[0]);
  if (std::fabs(rise) < Real(kParallel) * (end_x - start_x)) return end_x > 0 && start_x < length;
  const Real nearest_x = rise > 0 ? start_x : end_x;
  return nearest_x >= 0 && nearest_x <= length;
}

/// Returns, for parallel edges beside each other, the incident edge's end nearer to the reference; otherwise
/// the `deepest` corner.
template <class Real>
int nearest_end(const FacingEdges<Real>& edges, int deepest) {
  const Vec2<Real> tangent = perpendicular(edges.normal);
  const Vec2<Real> start = edges.incident[1] - edges.reference[0],
                   end = edges.incident[0] - edges.reference[0];
  const Real rise = dot(edges.normal, end - start), start_x = dot(tangent, start), end_x = dot(tangent, end);
  if (!(std::fabs(rise) < Real(kParallel) * (end_x - start_x))) return deepest;
  if (end_x <= 0) return edges.incident_id[0];
  return start_x >= dot(tangent, edges.reference[1] - edges.reference[0]) ? edges.incident_id[1] : deepest;
}

/// Moves an end of a span outwards along the outlines of both hulls, until the span contains the pivot or the
/// gap between the outlines exceeds `limit`. If both points lay on one side of the pivot, the contact would
/// rotate the bodies within a step past their nearly parallel next edges. The other end stays, because it may
/// be the deepest point. It moves as well if the outlines are parallel, so that no corner between the two
/// ends sinks.
template <class Real>
void extend(Span<Real>& span, const FacingEdges<Real>& edges, const Hull<Real>& reference,
            const Hull<Real>& other, Real pivot, Real limit) {
  const int far = pivot > span.x[1] ? 1 : 0, near = 1 - far;
  const Real sign = far == 1 ? Real(1) : Real(-1);
  const Vec2<Real> tangent = sign * perpendicular(edges.normal);
  // An outline's present edge: from a corner towards the pivot. Corners are numbered counter-clockwise, so
  // one outline is walked forwards and the other one backwards.
  struct Edge {
    int start, end;
    Real x, y, end_x, end_y;
  };
  const auto corner_x = [&](const Hull<Real>& hull, int i) { return dot(tangent, hull.point(i)); };
  const auto corner_y = [&](const Hull<Real>& hull, int i) {
    return dot(edges.normal, hull.point(i) - edges.reference[0]);
  };
  const auto edge_of = [&](const Hull<Real>& hull, int start, int end) {
    return Edge{
        start, end, corner_x(hull, start), corner_y(hull, start), corner_x(hull, end), corner_y(hull, end)};
  };
  const auto height = [](const Edge& edge, Real x) {
    return edge.y + (edge.end_y - edge.y) / (edge.end_x - edge.x) * (x - edge.x);
  };
  Edge on_reference = edge_of(reference, edges.reference_id[near], edges.reference_id[far]);
  Edge on_other = edge_of(other, edges.incident_id[far], edges.incident_id[near]);
  Real x = sign * span.x[far];
  while (x < sign * pivot) {
    const bool reference_ends = on_reference.end_x < on_other.end_x;
    if (reference_ends && reference.edges < reference.count) return;  // its neighbour is another shape
    const Hull<Real>& hull = reference_ends ? reference : other;
    Edge& edge = reference_ends ? on_reference : on_other;
    const bool forwards = reference_ends == (far == 1);
    edge = edge_of(hull, edge.end, forwards ? hull.next(edge.end) : hull.previous(edge.end));
    if (!(edge.end_x > edge.x && on_reference.end_x > on_reference.x && on_other.end_x > on_other.x)) return;
    const Real next = smaller(on_reference.end_x, on_other.end_x);
    const Real base = height(on_reference, next), gap = height(on_other, next) - base;
    if (!(gap <= limit)) return;
    if (span.gap[far] - span.gap[near] <= Real(kParallel) * (x - sign * span.x[near])) {
      span.x[near] = span.x[far], span.gap[near] = span.gap[far], span.base[near] = span.base[far];
      span.reference_id[near] = on_reference.start, span.incident_id[near] = on_other.start;
    }
    span.x[far] = sign * next, span.gap[far] = gap, span.base[far] = base;
    span.reference_id[far] = on_reference.end, span.incident_id[far] = on_other.end;
    x = next;
  }
}

/// Replaces two edges that are beside each other by the next ones on their outlines towards each other, as
/// long as these are parallel to the first ones, until two face each other; otherwise leaves them. On an
/// outline with corners that hardly stand out, the deepest corner may be far from the place where the shapes
/// touch, and rounding decides which of the edges is the farthest. Together such edges do what a single one
/// in their place would do.
template <class Real>
[[gnu::noinline]] bool bring_together(FacingEdges<Real>& edges, const Hull<Real>& reference,
                                      const Hull<Real>& other) {
  FacingEdges<Real> found = edges;
  const auto parallel = [](Vec2<Real> a, Vec2<Real> b) {
    return std::fabs(cross(a, b)) < Real(kParallel) && dot(a, b) > 0;
  };
  const Vec2<Real> incident_normal = other.normal(edges.incident_id[0]);
  const auto set_reference = [&](int edge) {
    found.reference_id[0] = edge, found.reference_id[1] = reference.next(edge);
    for (int i = 0; i < 2; ++i) found.reference[i] = reference.point(found.reference_id[i]);
    found.normal = reference.normal(edge);
  };
  for (int steps = reference.count + other.count; steps > 0; --steps) {
    const Vec2<Real> tangent = perpendicular(found.normal);
    const bool beyond = dot(tangent, found.incident[1] - found.reference[1]) > found.slack_after;
    const bool short_of = dot(tangent, found.incident[0] - found.reference[0]) < -found.slack_before;
    if (!beyond && !short_of) {
      edges = found;
      return true;
    }
    // An incident edge runs against the tangent.
    const int edge = found.incident_id[0], next = beyond ? other.next(edge) : other.previous(edge);
    if (next != edges.incident_id[0] && parallel(incident_normal, other.normal(next))) {
      found.incident_id[0] = next, found.incident_id[1] = other.next(next);
      for (int i = 0; i < 2; ++i) found.incident[i] = other.point(found.incident_id[i]);
      continue;
    }
    const int own = found.reference_id[0], beside = beyond ? reference.next(own) : reference.previous(own);
    if (reference.edges < reference.count) return false;  // its neighbour is another shape
    if (!parallel(edges.normal, reference.normal(beside))) return false;
    set_reference(beside);
  }
  return false;
}

/// Returns the part of two facing edges over each other, extended towards the pivot. Edges that are beside
/// each other may be replaced.
template <class Real>
inline Span<Real> span_of(FacingEdges<Real>& edges, const Hull<Real>& reference, const Hull<Real>& other,
                          Vec2<Real> pivot, Real limit) {
  Span<Real> span = clip(edges);
  if (!span.overlaps) [[unlikely]] {
    if (bring_together(edges, reference, other)) span = clip(edges);
  }
  const Real x = dot(perpendicular(edges.normal), pivot);
  if (span.overlaps && !(x >= span.x[0] && x <= span.x[1])) [[unlikely]]
    extend(span, edges, reference, other, x, limit);
  return span;
}

/// The faces of both hulls of greatest separation, and the point about which a contact's impulses do not
/// turn them relative to each other.
template <class Real>
struct Faces {
  Face<Real> a, b;
  Vec2<Real> pivot{};
};

/// Returns the manifold of two hulls that touch with the deepest corner only: their edges miss each other
/// because of rounding or of kPreference.
template <class Real>
ContactManifold<Real> corner_manifold(const Hull<Real>& a, const Hull<Real>& b, const Face<Real>& face,
                                      const FacingEdges<Real>& edges, Real max_separation,
                                      Vec2<Real> origin) {
  const bool reference_is_b = edges.reference_is_b;
  const Hull<Real>&reference = reference_is_b ? b : a, &other = reference_is_b ? a : b;
  const Vec2<Real> normal = reference.normal(face.edge);
  const int corner = nearest_end(edges, support<kAny>(other, normal));
  const Vec2<Real> point = other.point(corner);
  const int end = along(reference, face.edge, point) < 0 ? face.edge : reference.next(face.edge);
  if (reference_is_b)
    return single_point(origin + point, -normal, face.separation, a.radius, b.radius, max_separation,
                        corner_pair(corner, end));
  return single_point(origin + point - face.separation * normal, normal, face.separation, a.radius, b.radius,
                      max_separation, corner_pair(end, corner));
}

template <bool kOpen, class Real>
inline ContactManifold<Real> clip_or_corner(const Hull<Real>& a, const Hull<Real>& b,
                                            const Faces<Real>& faces, FacingEdges<Real>& edges,
                                            Real max_separation, Vec2<Real> origin) {
  const Hull<Real>&reference = edges.reference_is_b ? b : a, &other = edges.reference_is_b ? a : b;
  const Span<Real> span = span_of(edges, reference, other, faces.pivot, max_separation + a.radius + b.radius);
  ContactManifold<Real> out = points_of(span, edges, max_separation, origin);
  if (kOpen && out.count == 0)
    out = corner_manifold(a, b, edges.reference_is_b ? faces.b : faces.a, edges, max_separation, origin);
  return out;
}

/// Returns the manifold of two hulls that touch at a face of one of them.
template <class Real, class Admit>
inline ContactManifold<Real> face_manifold(const Hull<Real>& a, const Hull<Real>& b, const Faces<Real>& faces,
                                           FacingEdges<Real>& edges, Real max_separation, Vec2<Real> origin,
                                           const Admit& admit) {
  if (edges.reference_is_b) {
    const Normal answer = admit(-edges.normal);
    if (answer == Normal::Skip) return {};
    if (answer == Normal::Snap) edges = facing_edges<kAny>(a, faces.a.edge, b, false);
  }
  if (!edges.reference_is_b) admit.widen(edges);
  return clip_or_corner<Admit::kOpen>(a, b, faces, edges, max_separation, origin);
}

/// Returns the manifold of separated hulls whose nearest features are not two faces. While the same corners
/// stay in support, the separation along a normal is the distance times the cosine of the angle to the
/// nearest direction. So the face of greatest separation ends at, or is, the nearest feature of its hull.
template <class Real, class Admit>
ContactManifold<Real> separated_manifold(const Hull<Real>& a, const Hull<Real>& b, const Faces<Real>& faces,
                                         bool prefer_b, Real size, Real max_separation, Vec2<Real> origin,
                                         const Admit& admit) {
  const bool nearer_b = faces.b.separation > faces.a.separation;
  const Hull<Real>&reference = nearer_b ? b : a, &other = nearer_b ? a : b;
  const int edge = nearer_b ? faces.b.edge : faces.a.edge;
  // Of two equally deep ends of parallel edges side by side, take the nearer one if the far one may be within
  // `max_separation`: neither the thickness of a segment nor the edge of a rounded shape would separate it.
  const bool either = a.count == 2 || b.count == 2 || a.radius + b.radius > 0;
  const int deepest = support<kAny>(other, reference.normal(edge));
  const int corner =
      either ? nearest_end(facing_edges<kAny>(reference, edge, other, nearer_b), deepest) : deepest;
  const int place = along(reference, edge, other.point(corner));
  bool use_b = nearer_b;
  if (place != 0) {
    const int end = place < 0 ? edge : reference.next(edge);
    const int on_a = nearer_b ? corner : end, on_b = nearer_b ? end : corner;
    const Vec2<Real> offset = b.point(on_b) - a.point(on_a);
    const Real distance = std::sqrt(length_squared(offset));
    use_b = prefer_b;
    if (distance > kDirection<Real> * size) {
      const Vec2<Real> normal{offset.x / distance, offset.y / distance};
      const Normal answer = admit(normal);
      if (answer == Normal::Skip) return {};
      if (answer == Normal::Admit)
        return single_point(origin + a.point(on_a), normal, distance, a.radius, b.radius, max_separation,
                            corner_pair(on_a, on_b));
      use_b = false;
    }
  }
  FacingEdges<Real> edges =
      use_b ? facing_edges<kAny>(b, faces.b.edge, a, true) : facing_edges<kAny>(a, faces.a.edge, b, false);
  return face_manifold(a, b, faces, edges, max_separation, origin, admit);
}

/// Returns a manifold without points for shapes that a face separates.
template <class Real>
ContactManifold<Real> separated_by(int face) {
  ContactManifold<Real> out;
  out.separating = static_cast<std::uint8_t>(face);
  return out;
}

/// Computes the manifold of two hulls in one frame, whose origin lies at `origin` in a's frame; `pivot` is in
/// this frame. `size` returns the size of the smaller hull. `admit` selects the normals allowed; a snapped
/// normal becomes that of a's first edge. `kA` and `kB` are what is known at compile time about the numbers
/// of corners.
template <int kA, int kB, class Real, class Size, class Admit>
inline ContactManifold<Real> collide_hulls(const Hull<Real>& a, const Hull<Real>& b, const Size& size,
                                           Real max_separation, Vec2<Real> origin, Vec2<Real> pivot,
                                           const Admit& admit) {
  const Real limit = max_separation + a.radius + b.radius;
  Faces<Real> faces;
  faces.pivot = pivot;
  faces.a = farthest_face<kA, kB>(a, b, limit);
  if (faces.a.separation > limit) return separated_by<Real>(faces.a.edge);
  faces.b = farthest_face<kB, kA>(b, a, limit);
  if (faces.b.separation > limit) return separated_by<Real>(kMaxCorners + faces.b.edge);

  const bool prefer_b = faces.b.separation > faces.a.separation &&
                        faces.b.separation > faces.a.separation + Real(kPreference) * size();
  // One path for both: a branch here would be mispredicted half the time.
  constexpr int kOther = kA == kAny || kB == kAny ? kAny : kA == kB ? kA : kUpToFour;
  const Hull<Real>&reference = prefer_b ? b : a, &other = prefer_b ? a : b;
  FacingEdges<Real> edges =
      facing_edges<kOther>(reference, prefer_b ? faces.b.edge : faces.a.edge, other, prefer_b);
  const bool apart = faces.a.separation > 0 || faces.b.separation > 0;
  if (apart && !over_edge(edges) && !(bring_together(edges, reference, other) && over_edge(edges)))
    return separated_manifold(a, b, faces, prefer_b, size(), max_separation, origin, admit);
  return face_manifold(a, b, faces, edges, max_separation, origin, admit);
}

}  // namespace plumb::narrow
