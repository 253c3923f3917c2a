#include "engine/collision/distance/hull_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace plumb {
namespace {

constexpr double kDistanceRounding = 2 * std::numeric_limits<double>::epsilon();

/// A corner of the Minkowski difference b - a, whose distance from the origin is that of a and b.
struct Vertex {
  Vec2d w;
  int a = 0, b = 0;  ///< its corners
};

/// Two hulls in a's frame.
template <class Real>
struct Hulls {
  const Convex<Real>& a;
  const Convex<Real>& b;
  const Pose<double>& b_in_a;

  Vec2d local_b(int j) const { return b.corners[j].point.template as<double>(); }
  Vec2d corner_a(int i) const { return a.corners[i].point.template as<double>(); }
  Vec2d corner_b(int j) const { return b_in_a.position + b_in_a.rotation * local_b(j); }
  Vertex vertex(int i, int j) const { return {corner_b(j) - corner_a(i), i, j}; }

  /// Returns the vertex farthest along -direction.
  Vertex lowest(Vec2d direction) const {
    return vertex(farthest_corner(a, direction),
                  farthest_corner(b, -(b_in_a.rotation.inverse() * direction)));
  }

  /// Returns vertex q - vertex p, computed from the corners: a difference of the two `w` would also contain
  /// the rounding that the distance between the shapes adds.
  Vec2d edge(const Vertex& p, const Vertex& q) const {
    return b_in_a.rotation * (local_b(q.b) - local_b(p.b)) - (corner_a(q.a) - corner_a(p.a));
  }
};

/// One or two vertices and the point of their segment nearest to the origin; count is 3 when the origin is
/// inside.
struct Simplex {
  Vertex vertices[2];
  int count = 0;
  Vec2d outward;      ///< from the origin to the nearest point, at any length
  double square = 0;  ///< m^2, the distance squared
};

Simplex point_simplex(const Vertex& p) { return {{p, {}}, 1, p.w, length_squared(p.w)}; }

/// Finds the point of the segment p q nearest to the origin.
Simplex segment_simplex(const Vertex& p, const Vertex& q) {
  const Vec2d e = q.w - p.w;
  const double before = -dot(p.w, e), after = dot(q.w, e);
  if (!(before > 0)) return point_simplex(p);
  if (!(after > 0)) return point_simplex(q);
  // The foot of the perpendicular is p - (p . e) e / e^2 = (p . m) m / e^2, with m = e rotated by a right
  // angle. The second form has no difference of nearly equal lengths.
  const Vec2d m = perpendicular(e);
  const double height = dot(p.w, m), size = length_squared(e);
  return {{p, q}, 2, height < 0 ? -m : m, height * height / size};
}

/// Reduces the triangle of a segment and the vertex r beyond it. Its nearest part contains r, unless the
/// origin is inside (count 3), because r is nearer than the segment.
Simplex triangle_simplex(const Simplex& segment, const Vertex& r) {
  const Vertex &p = segment.vertices[0], &q = segment.vertices[1];
  const double pq = cross(p.w, q.w), qr = cross(q.w, r.w), rp = cross(r.w, p.w);
  if ((pq >= 0 && qr >= 0 && rp >= 0) || (pq <= 0 && qr <= 0 && rp <= 0)) return {{p, q}, 3, {}, 0};
  const Simplex first = segment_simplex(p, r), second = segment_simplex(q, r);
  return first.square <= second.square ? first : second;
}

double size_of(Vec2d v) { return std::abs(v.x) + std::abs(v.y); }

template <class Real>
Simplex first_simplex(const Hulls<Real>& hulls, const SimplexCache* cache) {
  if (cache && cache->count > 0) {
    const auto valid = [&](int k) {
      return cache->corner_a[k] < hulls.a.count && cache->corner_b[k] < hulls.b.count;
    };
    if (valid(0)) {
      const Vertex first = hulls.vertex(cache->corner_a[0], cache->corner_b[0]);
      if (cache->count == 1 || !valid(1)) return point_simplex(first);
      return segment_simplex(first, hulls.vertex(cache->corner_a[1], cache->corner_b[1]));
    }
  }
  return point_simplex(hulls.lowest(hulls.b_in_a.position));
}

/// A separating axis: an edge's normal with the signed distance along it.
struct Axis {
  double separation = -std::numeric_limits<double>::infinity();
  Vec2d normal;   ///< outward
  Vec2d on_edge;  ///< below the deepest corner of the other shape
};

/// Returns the edge normal of `shape` with the greatest separation from `other`.
template <class Real>
Axis best_axis(const Convex<Real>& shape, const Pose<double>& at, const Convex<Real>& other,
               const Pose<double>& other_at) {
  Axis best;
  for (int i = 0; i < shape.count && shape.count > 1; ++i) {
    const Vec2d start = shape.corners[i].point.template as<double>();
    const Vec2d end = shape.corners[i + 1 < shape.count ? i + 1 : 0].point.template as<double>();
    const Vec2d p = at.position + at.rotation * start, e = at.rotation * (end - start);
    const double length = std::sqrt(length_squared(e));
    if (!(length > 0)) continue;
    const Vec2d normal{e.y / length, -e.x / length};
    const int j = farthest_corner(other, -(other_at.rotation.inverse() * normal));
    const Vec2d from_p =
        other_at.position + other_at.rotation * other.corners[j].point.template as<double>() - p;
    const double separation = dot(normal, from_p);
    if (!(separation > best.separation)) continue;
    // The corner projects onto the edge, unless the edge is parallel to one of the other shape: then any
    // common point will do.
    const double along = std::clamp(dot(from_p, e) / (length * length), 0.0, 1.0);
    best = {separation, normal, p + along * e};
  }
  return best;
}

template <class Real>
HullDistance apart(const Hulls<Real>& hulls, const Simplex& simplex) {
  const Vertex& p = simplex.vertices[0];
  HullDistance out;
  if (simplex.count == 1) {
    out.separation = std::sqrt(simplex.square);
    out.normal = {p.w.x / out.separation, p.w.y / out.separation};
    out.point_a = hulls.corner_a(p.a);
    out.point_b = hulls.corner_b(p.b);
    return out;
  }
  const Vertex& q = simplex.vertices[1];
  const Vec2d e = hulls.edge(p, q), m = perpendicular(e);
  const double length = std::sqrt(length_squared(e)), side = dot(m, simplex.outward) < 0 ? -length : length;
  const double part = std::clamp(-dot(p.w, e) / (length * length), 0.0, 1.0);
  out.normal = {m.x / side, m.y / side};
  out.point_a = hulls.corner_a(p.a) + part * (hulls.corner_a(q.a) - hulls.corner_a(p.a));
  out.point_b = hulls.corner_b(p.b) + part * (hulls.corner_b(q.b) - hulls.corner_b(p.b));
  out.separation = dot(out.normal, part < 0.5 ? p.w : q.w);
  return out;
}

void store(const Simplex& simplex, SimplexCache* cache) {
  if (!cache) return;
  cache->count = static_cast<std::uint8_t>(simplex.count < 2 ? simplex.count : 2);
  for (int k = 0; k < cache->count; ++k) {
    cache->corner_a[k] = static_cast<std::uint8_t>(simplex.vertices[k].a);
    cache->corner_b[k] = static_cast<std::uint8_t>(simplex.vertices[k].b);
  }
}

}  // namespace

// The least translation that separates two overlapping hulls is along an edge's normal, because their
// Minkowski difference has no other edges.
template <class Real>
HullDistance edge_separation(const Convex<Real>& a, const Convex<Real>& b, const Pose<double>& b_in_a) {
  const Axis of_a = best_axis(a, {}, b, b_in_a), of_b = best_axis(b, b_in_a, a, {});
  HullDistance out;
  if (std::max(of_a.separation, of_b.separation) == -std::numeric_limits<double>::infinity()) {
    const Hulls<Real> hulls{a, b, b_in_a};
    out.normal = {0, 1};  // two coinciding points give no direction: treat as converged
    out.point_a = hulls.corner_a(0);
    out.point_b = hulls.corner_b(0);
  } else if (of_a.separation >= of_b.separation) {
    out.normal = of_a.normal;
    out.separation = of_a.separation;
    out.point_a = of_a.on_edge;
    out.point_b = of_a.on_edge + of_a.separation * out.normal;
  } else {
    out.normal = -of_b.normal;
    out.separation = of_b.separation;
    out.point_b = of_b.on_edge;
    out.point_a = out.point_b - of_b.separation * out.normal;
  }
  return out;
}

template <class Real>
double separation_along(const Convex<Real>& a, const Convex<Real>& b, const Pose<double>& b_in_a,
                        Vec2d normal) {
  return dot(normal, Hulls<Real>{a, b, b_in_a}.lowest(normal).w);
}

template <class Real>
HullDistance hull_distance(const Convex<Real>& a, const Convex<Real>& b, const Pose<double>& b_in_a,
                           SimplexCache* cache) {
  constexpr double kGrowth = 1 + 1e-12;  // more than roundings of a square
  constexpr double kSmallest = std::numeric_limits<double>::min();
  constexpr int kMaxIterations =
      2 * kMaxCorners;  // below 15 in tests; roundings may cycle, but the result is accurate then
  const Hulls<Real> hulls{a, b, b_in_a};
  Simplex simplex = first_simplex(hulls, cache);
  int iteration = 0;
  bool touching = !(simplex.square > kSmallest);
  while (!touching && iteration < kMaxIterations) {
    ++iteration;
    const Vertex next = hulls.lowest(simplex.outward);
    // Except for rounding, no vertex lies nearer to the origin along the normal. A vertex that is already in
    // the simplex never gains more than rounding: |m . (p - q)| with m = fl(p - q) turned stays below 2
    // epsilon |m| (|p| + |q|).
    const Vec2d reference = simplex.vertices[0].w;
    const double gain = dot(simplex.outward, reference - next.w);
    if (!(gain > kDistanceRounding * size_of(simplex.outward) * (size_of(reference) + size_of(next.w))))
      break;
    const Simplex nearer =
        simplex.count == 1 ? segment_simplex(simplex.vertices[0], next) : triangle_simplex(simplex, next);
    // A gain makes the distance smaller, unless the old distance was only rounding. In that case the origin
    // is on the segment, with the difference on both sides of it.
    touching = nearer.count == 3 || !(nearer.square > kSmallest) || nearer.square > kGrowth * simplex.square;
    simplex = nearer;
  }
  store(simplex, cache);
  HullDistance out = touching ? edge_separation(a, b, b_in_a) : apart(hulls, simplex);
  out.iterations = iteration;
  return out;
}

#define PLUMB_INSTANTIATE(Real)                                                                         \
  template HullDistance hull_distance(const Convex<Real>&, const Convex<Real>&, const Pose<double>&,    \
                                      SimplexCache*);                                                   \
  template HullDistance edge_separation(const Convex<Real>&, const Convex<Real>&, const Pose<double>&); \
  template double separation_along(const Convex<Real>&, const Convex<Real>&, const Pose<double>&, Vec2d);
PLUMB_INSTANTIATE(float)
PLUMB_INSTANTIATE(double)
#undef PLUMB_INSTANTIATE

}  // namespace plumb
