#include "engine/collision/manifold/internal_edge.h"

#include <algorithm>
#include <cmath>

#include "engine/collision/manifold/hull_pair.h"

namespace plumb {
namespace {

/// Cosine of the angle (60 degrees) from which two adjoining faces form a corner instead of one surface.
template <class Real>
constexpr Real kSameSurface = Real(0.5);

/// Both in units of the tolerance: the widest gap that counts as closed, and how far a face is extended
/// across it.
template <class Real>
constexpr Real kMaxGap = 3;
template <class Real>
constexpr Real kFaceExtension = 4;

/// Sine of the largest angle between normals that count as equal.
template <class Real>
constexpr Real kAligned = 16 * std::numeric_limits<Real>::epsilon();

template <class Real>
int next_of(const Convex<Real>& shape, int i) {
  return i + 1 < shape.count ? i + 1 : 0;
}
template <class Real>
int previous_of(const Convex<Real>& shape, int i) {
  return i > 0 ? i - 1 : shape.count - 1;
}

/// Returns the middle of the shape that touches a surface, m.
template <class Real>
Vec2<Real> middle_of_mover(const TouchedSurface<Real>& touched) {
  const Convex<Real>& mover = touched.mover;
  Vec2<Real> middle{};
  for (int i = 0; i < mover.count; ++i)
    middle += (1 / static_cast<Real>(mover.count)) * mover.corners[i].point;
  return touched.mover_pose.position + touched.mover_pose.rotation * middle;
}

/// The neighbour's face that continues the surface beyond a corner, if there is one.
template <class Real>
struct Continuation {
  bool found = false;
  Vec2<Real> normal{};
};

/// Searches for the continuation at one end of `face`.
template <class Real>
Continuation<Real> beyond(const TouchedSurface<Real>& touched, int face, bool at_start,
                          const Convex<Real>& other, int other_edges, const Pose<Real>& pose) {
  const Corner<Real>& first = touched.shape.corners[face];
  const Corner<Real>& corner = at_start ? first : touched.shape.corners[next_of(touched.shape, face)];
  const Vec2<Real> end = corner.point + touched.shape.radius * first.normal;
  const Vec2<Real> out = at_start ? -perpendicular(first.normal) : perpendicular(first.normal);
  const Vec2<Real> offset = pose.position - end;
  const Real gap = kMaxGap<Real> * touched.tolerance;
  for (int k = 0; k < other_edges; ++k) {
    const Vec2<Real> normal = pose.rotation * other.corners[k].normal;
    if (!(dot(normal, first.normal) > kSameSurface<Real>)) continue;
    const Vec2<Real> tangent = perpendicular(normal);
    const Vec2<Real> from = offset + pose.rotation * other.corners[k].point;
    if (std::fabs(dot(normal, from) + other.radius) > touched.tolerance) continue;
    const Vec2<Real> to = offset + pose.rotation * other.corners[next_of(other, k)].point;
    const Real low = dot(tangent, from), high = dot(tangent, to);
    if (low > gap || high < -gap) continue;
    if ((dot(tangent, out) > 0 ? high : -low) > gap) return {true, normal};
  }
  return {};
}

/// Returns true if a point lies in the other shape, enlarged by `margin`.
template <class Real>
bool inside(Vec2<Real> point, const Convex<Real>& other, int other_edges, const Pose<Real>& pose,
            Real margin) {
  if (other_edges < 2) return false;
  const Vec2<Real> local = pose.rotation.inverse() * (point - pose.position);
  for (int k = 0; k < other.count; ++k) {
    if (dot(other.corners[k].normal, local - other.corners[k].point) > other.radius + margin) return false;
  }
  return true;
}

/// Returns true if every point of a separated contact, moved by two tolerances along the normal, is in the
/// other shape.
template <class Real>
bool hidden(const TouchedSurface<Real>& touched, const Convex<Real>& other, int other_edges,
            const Pose<Real>& pose) {
  const Vec2<Real> step = (2 * touched.tolerance) * touched.normal;
  for (int i = 0; i < touched.count; ++i)
    if (!inside(touched.points[i] + step, other, other_edges, pose, Real(0))) return false;
  return true;
}

/// Returns true if the other shape covers an edge at every point of the contact. The test is inconclusive
/// near the end at which the surface continues, so points are tested a small distance away from it.
template <class Real>
bool covered(const TouchedSurface<Real>& touched, int edge, bool at_start, const Convex<Real>& other,
             int other_edges, const Pose<Real>& pose) {
  const Convex<Real>& shape = touched.shape;
  const Vec2<Real> first = shape.corners[edge].point, normal = shape.corners[edge].normal;
  const Vec2<Real> tangent = perpendicular(normal);
  const Real length = dot(tangent, shape.corners[next_of(shape, edge)].point - first);
  const Real inset = std::min(2 * kFaceExtension<Real> * touched.tolerance, Real(0.5) * length);
  const Real low = at_start ? inset : -length, high = at_start ? 2 * length : length - inset;
  const Vec2<Real> before = first + (shape.radius + 2 * touched.tolerance) * normal;
  for (int i = 0; i < touched.count; ++i) {
    const Real x = std::clamp(dot(tangent, touched.points[i] - first), low, high);
    if (!inside(before + x * tangent, other, other_edges, pose, touched.tolerance)) return false;
  }
  return true;
}

/// Returns true if an edge leaves the other shape towards the middle of the touching shape, like a wall that
/// stands in the floor. It is then part of the union's surface, however deep the points lie. Close to its
/// ends the test is inconclusive.
template <class Real>
bool comes_out(const TouchedSurface<Real>& touched, int edge, const Convex<Real>& other, int other_edges,
               const Pose<Real>& pose) {
  const Convex<Real>& shape = touched.shape;
  const Vec2<Real> first = shape.corners[edge].point, normal = shape.corners[edge].normal;
  const Vec2<Real> tangent = perpendicular(normal);
  const Real length = dot(tangent, shape.corners[next_of(shape, edge)].point - first);
  const Real inset = std::min(2 * kFaceExtension<Real> * touched.tolerance, Real(0.5) * length);
  const Real x = std::clamp(dot(tangent, middle_of_mover(touched) - first), inset, length - inset);
  const Vec2<Real> before = first + (shape.radius + 2 * touched.tolerance) * normal;
  return !inside(before + x * tangent, other, other_edges, pose, touched.tolerance);
}

/// Returns true if a normal lies between those of a face and its continuation, around the corner between
/// them.
template <class Real>
bool between(Vec2<Real> face, Vec2<Real> normal, Vec2<Real> continuation, bool at_start) {
  const Real side = at_start ? Real(-1) : Real(1);
  return side * cross(face, normal) >= -kAligned<Real> &&
         side * cross(normal, continuation) >= -kAligned<Real>;
}

}  // namespace

template <class Real>
InternalEdgeResult<Real> check_internal_edge(const TouchedSurface<Real>& touched,
                                             const Convex<Real>& neighbour, int neighbour_edges,
                                             const Pose<Real>& pose) {
  using Answer = InternalEdgeResult<Real>;
  const Convex<Real>& shape = touched.shape;
  const Vec2<Real> n = touched.normal;
  int edge = 0;
  Real nearest = dot(n, shape.corners[0].normal);
  for (int i = 1; i < touched.edges; ++i)
    if (const Real along = dot(n, shape.corners[i].normal); along > nearest) nearest = along, edge = i;
  if (touched.apart && hidden(touched, neighbour, neighbour_edges, pose)) {
    const bool on_edge = shape.count > 1 && std::fabs(cross(n, shape.corners[edge].normal)) <= kAligned<Real>;
    if (!on_edge || !comes_out(touched, edge, neighbour, neighbour_edges, pose))
      return {Answer::Kind::Hidden, 0, false, 0};
  }
  if (shape.count < 2) return {};
  const Vec2<Real> first = shape.corners[edge].point, second = shape.corners[next_of(shape, edge)].point;
  const Vec2<Real> own = shape.corners[edge].normal, tangent = perpendicular(own);
  const auto face_at = [&](int face, bool at_start) {
    const Corner<Real>& corner = shape.corners[face];
    return Answer{Answer::Kind::Face, face, at_start,
                  dot(corner.normal, middle_of_mover(touched) - corner.point)};
  };
  // Returns the adjacent face beyond the edge's first or second corner. The corner with the seam is the
  // second of the one and the first of the other.
  const auto across = [&](bool at_start) {
    return at_start ? previous_of(shape, edge) : next_of(shape, edge);
  };

  // Continues around the corner, unless the normal is that of the edge.
  const Real tilt = dot(n, tangent);
  if (std::fabs(tilt) > kAligned<Real>) {
    const bool at_start = tilt < 0;
    const Vec2<Real> corner = (at_start ? first : second) + shape.radius * n;
    const Real near = kFaceExtension<Real> * touched.tolerance;
    bool at_corner = false;
    for (int i = 0; i < touched.count; ++i)
      at_corner |= length_squared(touched.points[i] - corner) <= near * near;
    Answer answer;
    const auto look = [&](int face, bool face_at_start) {
      if (!at_corner || face >= touched.edges) return;
      const Continuation<Real> on = beyond(touched, face, face_at_start, neighbour, neighbour_edges, pose);
      if (!on.found || between(shape.corners[face].normal, n, on.normal, face_at_start)) return;
      const Answer found = face_at(face, face_at_start);
      if (answer.kind == Answer::Kind::Own || found.height > answer.height) answer = found;
    };
    look(edge, at_start);
    look(across(at_start), !at_start);
    if (answer.kind != Answer::Kind::Own) return answer;
  }

  // The edge itself, if the neighbour covers it: the surface then continues at the edge's nearer end.
  Real middle = 0;
  for (int i = 0; i < touched.count; ++i) middle += dot(tangent, touched.points[i] - first);
  const bool at_start = 2 * middle < static_cast<Real>(touched.count) * dot(tangent, second - first);
  const int other = across(at_start);
  if (other >= touched.edges || other == edge) return {};
  if (!covered(touched, edge, at_start, neighbour, neighbour_edges, pose)) return {};
  if (comes_out(touched, edge, neighbour, neighbour_edges, pose)) return {};
  if (!beyond(touched, other, !at_start, neighbour, neighbour_edges, pose).found) return {};
  return face_at(other, !at_start);
}

template <class Real>
ContactManifold<Real> collide_face(const Convex<Real>& a, int face, bool at_start, Real slack,
                                   const Convex<Real>& b, const Pose<Real>& b_in_a, Real max_separation,
                                   Vec2<Real> pivot) {
  using namespace narrow;
  const Vec2<Real> origin = a.corners[face].point, normal = a.corners[face].normal;
  const Vec2<Real> end = a.corners[next_of(a, face)].point - origin;
  if (b.count == 1) {
    const Vec2<Real> offset = (b_in_a.position - origin) + b_in_a.rotation * b.corners[0].point;
    const Vec2<Real> tangent = perpendicular(normal);
    const Real x = dot(tangent, offset), height = dot(normal, offset);
    const Real low = at_start ? -slack : Real(0), high = dot(tangent, end) + (at_start ? Real(0) : slack);
    if (x < low || x > high) return {};
    return single_point(origin + x * tangent, normal, height, a.radius, b.radius, max_separation, 0);
  }
  Hull<Real> hull_a, hull_b;
  place<kAny>(hull_a, a, origin);
  hull_a.edges = 1;  // the given one
  place<kAny>(hull_b, b, b_in_a.rotation, b_in_a.position - origin);
  FacingEdges<Real> edges = facing_edges<kAny>(hull_a, face, hull_b, false);
  (at_start ? edges.slack_before : edges.slack_after) = slack;
  const Span<Real> span =
      span_of(edges, hull_a, hull_b, pivot - origin, max_separation + a.radius + b.radius);
  return points_of(span, edges, max_separation, origin);
}

template <class Real>
ContactManifold<Real> swapped_manifold(const ContactManifold<Real>& found, const Pose<Real>& b_in_a) {
  return narrow::swapped(found, b_in_a);
}

#define PLUMB_INSTANTIATE(Real)                                                                           \
  template InternalEdgeResult<Real> check_internal_edge(const TouchedSurface<Real>&, const Convex<Real>&, \
                                                        int, const Pose<Real>&);                          \
  template ContactManifold<Real> collide_face(const Convex<Real>&, int, bool, Real, const Convex<Real>&,  \
                                              const Pose<Real>&, Real, Vec2<Real>);                       \
  template ContactManifold<Real> swapped_manifold(const ContactManifold<Real>&, const Pose<Real>&);
PLUMB_INSTANTIATE(float)
PLUMB_INSTANTIATE(double)
#undef PLUMB_INSTANTIATE

}  // namespace plumb
