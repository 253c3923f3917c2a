#include "engine/world/state/internal_edges.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/collision/manifold/internal_edge.h"
#include "engine/world/ablation/ablation.h"
#include "engine/world/state/constants.h"
#include "engine/world/state/contact_setup.h"
#include "engine/world/state/contacts.h"

namespace plumb {
namespace {

template <class Real>
Pose<Real> inverse(const Pose<Real>& pose) {
  const Rotation<Real> back = pose.rotation.inverse();
  return {-(back * pose.position), back};
}

// One side of a contact, computed when the first neighbour is tested.
template <class Real>
struct Side {
  bool computed = false;    // the members below are computed
  int shape = 0, body = 0;  // of the touched shape
  TouchedSurface<Real> touched;
  InternalEdgeResult<Real> result{};
};

template <class Real>
void compute_side(const WorldData<Real>& w, const ContactRecord& contact, bool of_b, const Pose<Real>& b_in_a,
                  const ContactManifold<Real>& manifold, Side<Real>& side) {
  side.computed = true;
  side.shape = of_b ? contact.shape_b : contact.shape_a;
  side.body = of_b ? contact.body_b : contact.body_a;
  TouchedSurface<Real>& touched = side.touched;
  touched.shape = w.convex(side.shape);
  touched.edges = w.forms[side.shape].chain ? 1 : touched.shape.count;
  const Pose<Real> to_b = of_b ? inverse(b_in_a) : Pose<Real>{};
  touched.normal = of_b ? -(to_b.rotation * manifold.normal) : manifold.normal;
  touched.count = manifold.count;
  touched.mover = w.convex(of_b ? contact.shape_a : contact.shape_b);
  touched.mover_pose = of_b ? to_b : b_in_a;
  Real min_separation = manifold.points[0].separation, size = 0;
  for (int i = 0; i < manifold.count; ++i) {
    const ContactManifoldPoint<Real>& point = manifold.points[i];
    const Vec2<Real> at = of_b ? to_b.position + to_b.rotation * point.point : point.point;
    touched.points[i] = at - (Real(0.5) * point.separation) * touched.normal;
    min_separation = std::min(min_separation, point.separation);
    size = std::max(size, l1_norm(at));
  }
  const Real smaller = std::min(w.forms[contact.shape_a].extent, w.forms[contact.shape_b].extent);
  touched.tolerance =
      Real(tuning::kInternalEdgeTolerance) * smaller + 32 * std::numeric_limits<Real>::epsilon() * size;
  touched.apart = min_separation > 2 * touched.tolerance;
}

// A manifold's points in the world, and the margin within which neighbours count.
template <class Real>
struct Region {
  Vec2<Real> points[2];
  int count = 0;
  Real margin = 0;
  Aabb<Real> box{};
};

template <class Real>
Region<Real> region_of(const WorldData<Real>& w, const ContactRecord& contact,
                       const ContactManifold<Real>& manifold, Real smaller, Real displacement) {
  const Vec2<Real> at = w.position[contact.body_a].template as<Real>();
  const Rotation<Real> q = w.rotation[contact.body_a];
  Region<Real> region;
  region.count = manifold.count;
  Real max_separation = 0;
  for (int i = 0; i < manifold.count; ++i) {
    const Vec2<Real> point = region.points[i] = at + q * manifold.points[i].point;
    region.box = i == 0 ? Aabb<Real>{point, point} : merged(region.box, Aabb<Real>{point, point});
    max_separation = std::max(max_separation, std::abs(manifold.points[i].separation));
  }
  const Real rounding = 8 * std::numeric_limits<Real>::epsilon() * (l1_norm(at) + l1_norm(region.points[0]));
  region.margin = displacement + Real(0.5) * max_separation +
                  Real(4 * tuning::kInternalEdgeTolerance) * smaller + rounding;
  region.box = region.box.grown(region.margin);
  return region;
}

// Returns true if a shape is within the margin of one of the points.
template <class Real>
bool is_within_margin(const WorldData<Real>& w, int shape, const Region<Real>& region) {
  const Convex<Real> convex = w.convex(shape);
  const int body = w.shapes[shape].body;
  const Rotation<Real> back = w.rotation[body].inverse();
  for (int i = 0; i < region.count; ++i) {
    const Vec2<Real> local = back * (region.points[i] - w.position[body].template as<Real>());
    bool inside = true;
    for (int k = 0; k < convex.count && inside; ++k)
      inside =
          dot(convex.corners[k].normal, local - convex.corners[k].point) <= convex.radius + region.margin;
    if (inside) return true;
  }
  return false;
}

template <class Real>
Pose<Real> pose_in(const WorldData<Real>& w, int body, int frame) {
  if (body == frame) return {{0, 0}, {1, 0}};
  const Rotation<Real> back = w.rotation[frame].inverse(), q = w.rotation[body];
  return {back * (w.position[body] - w.position[frame]).template as<Real>(),
          {back.c * q.c - back.s * q.s, back.s * q.c + back.c * q.s}};
}

// Returns true if a neighbour and the touched shape cannot move relative to each other: on one body, or if
// neither is dynamic.
template <class Real>
bool is_attached(const WorldData<Real>& w, const Side<Real>& side, int neighbour) {
  return neighbour == side.body || (!w.is_dynamic(neighbour) && !w.is_dynamic(side.body));
}

// Returns true if a face is preferred to another one. Decides ties too, so that the order in which neighbours
// are tested does not matter.
template <class Real>
bool is_preferred(const InternalEdgeResult<Real>& face, const InternalEdgeResult<Real>& other) {
  if (face.height != other.height) return face.height > other.height;
  if (face.face != other.face) return face.face < other.face;
  return face.at_start && !other.at_start;
}

// Tests a neighbour. If it gives several faces, keeps the one that the other shape is farthest in front of.
template <class Real>
void test_neighbour(const WorldData<Real>& w, Side<Real>& side, int neighbour) {
  using Kind = typename InternalEdgeResult<Real>::Kind;
  if (side.result.kind == Kind::Hidden) return;
  if (!is_attached(w, side, w.shapes[neighbour].body)) return;
  const Convex<Real> shape = w.convex(neighbour);
  const InternalEdgeResult<Real> result =
      check_internal_edge(side.touched, shape, w.forms[neighbour].chain ? 1 : shape.count,
                          pose_in(w, w.shapes[neighbour].body, side.body));
  if (result.kind == Kind::Hidden ||
      (result.kind == Kind::Face && (side.result.kind == Kind::Own || is_preferred(result, side.result))))
    side.result = result;
}

// Returns the body whose contacts are searched for neighbours: of two dynamic bodies the one with fewer
// constraints.
template <class Real>
int body_to_search(const WorldData<Real>& w, const ContactRecord& contact) {
  if (!w.is_dynamic(contact.body_a)) return contact.body_b;
  if (!w.is_dynamic(contact.body_b)) return contact.body_a;
  return w.bodies[contact.body_b].constraints < w.bodies[contact.body_a].constraints ? contact.body_b
                                                                                     : contact.body_a;
}

template <class Real>
ContactManifold<Real> collide_on_face(const WorldData<Real>& w, const ContactRecord& contact,
                                      const Side<Real>& side, const Pose<Real>& b_in_a, Real margin) {
  const Convex<Real> shape_a = w.convex(contact.shape_a), shape_b = w.convex(contact.shape_b);
  const Real tolerance = 4 * side.touched.tolerance;
  const Vec2<Real> pivot = pivot_between(w, contact, b_in_a);
  if (side.shape == contact.shape_a)
    return collide_face(shape_a, side.result.face, side.result.at_start, tolerance, shape_b, b_in_a, margin,
                        pivot);
  const Pose<Real> a_in_b = inverse(b_in_a);
  const ContactManifold<Real> found =
      collide_face(shape_b, side.result.face, side.result.at_start, tolerance, shape_a, a_in_b, margin,
                   a_in_b.position + a_in_b.rotation * pivot);
  return swapped_manifold(found, b_in_a);
}

// Returns the least separation of a manifold's points, 0 if none overlaps.
template <class Real>
Real deepest_of(const ContactManifold<Real>& manifold) {
  Real deepest = 0;
  for (int k = 0; k < manifold.count; ++k) deepest = std::min(deepest, manifold.points[k].separation);
  return deepest;
}

// Returns true if the contact's bodies slide along a face of one of them rather than approach it. Where four
// corners meet at a point, an internal edge could belong to either body's surface; the motion decides.
template <class Real>
bool slides_along(const WorldData<Real>& w, const ContactRecord& contact, const Side<Real>& side) {
  const SolverBody<Real>&a = w.motion[contact.body_a], &b = w.motion[contact.body_b];
  const Rotation<Real> q = w.rotation[side.body];
  const Vec2<Real> from_side = q * side.touched.points[0];
  const Vec2<Real> a_to_b = (w.position[contact.body_b] - w.position[contact.body_a]).template as<Real>();
  const bool of_b = side.shape == contact.shape_b;
  const Vec2<Real> arm_a = of_b ? from_side + a_to_b : from_side,
                   arm_b = of_b ? from_side : from_side - a_to_b;
  const Vec2<Real> velocity = (b.velocity + b.angular_velocity * perpendicular(arm_b)) -
                              (a.velocity + a.angular_velocity * perpendicular(arm_a));
  const Vec2<Real> normal = q * side.touched.shape.corners[side.result.face].normal;
  return std::abs(cross(normal, velocity)) > std::abs(dot(normal, velocity));
}

template <class Real>
struct Sides {
  Side<Real> of_a, of_b;
};

// Maximum number of shapes of two dynamic bodies for testing all of them as neighbours. With more shapes,
// only those with contacts are tested. Bodies of a few convex parts have fewer shapes than contacts.
constexpr int kMaxTestedShapes = 16;

// Returns true if a body has at most `most` shapes, and subtracts their number from `most`.
template <class Real>
bool has_few_shapes(const WorldData<Real>& w, int body, int& most) {
  int shape = w.bodies[body].first_shape;
  while (shape != kNone && most > 0) shape = w.shapes[shape].next, --most;
  return shape == kNone;
}

// Calls visit(shape, shape it must have a contact with) for the shapes that may continue the surface of a
// contact between two dynamic bodies: the other shapes of both.
template <class Real, class Visit>
void for_each_sibling(const WorldData<Real>& w, const ContactRecord& contact, const Visit& visit) {
  for (int shape = w.bodies[contact.body_a].first_shape; shape != kNone; shape = w.shapes[shape].next)
    if (shape != contact.shape_a) visit(shape, contact.shape_b);
  for (int shape = w.bodies[contact.body_b].first_shape; shape != kNone; shape = w.shapes[shape].next)
    if (shape != contact.shape_b) visit(shape, contact.shape_a);
}

// Calls visit(shape, kNone) for all shapes that have a contact with one of the contact's shapes and belong
// to the other shape's side. Searches the contacts of `searched_body`.
template <class Real, class Visit>
void for_each_touching(const WorldData<Real>& w, const ContactRecord& contact, int searched_body,
                       const Visit& visit) {
  const bool searches_a = searched_body == contact.body_a;
  const int own = searches_a ? contact.shape_a : contact.shape_b,
            other = searches_a ? contact.shape_b : contact.shape_a;
  for (int edge = w.bodies[searched_body].first_contact; edge != kNone;) {
    const ContactRecord& record = w.contacts[edge / 2];
    const bool is_a = (edge & 1) == 0;
    edge = record.next[edge & 1];
    const int neighbour = is_a ? record.shape_b : record.shape_a,
              of_searched = is_a ? record.shape_a : record.shape_b;
    // Only shapes that have a contact with the sliding shape count as neighbours, so this body's list
    // contains them all.
    if (of_searched == own && neighbour != other) visit(neighbour, kNone);
    if (neighbour == other && of_searched != own) visit(of_searched, kNone);
  }
}

// Returns true if a manifold's two points are farther apart than `max_width`.
template <class Real>
bool is_wide(const ContactManifold<Real>& manifold, Real max_width) {
  return manifold.count == 2 &&
         length_squared(manifold.points[1].point - manifold.points[0].point) > max_width * max_width;
}

// Tests the neighbours of both sides of a contact.
template <class Real>
void test_neighbours(const WorldData<Real>& w, const ContactRecord& contact, const Pose<Real>& b_in_a,
                     const ContactManifold<Real>& manifold, Real smaller, Real displacement,
                     bool both_dynamic, Sides<Real>& sides) {
  const int searched_body = body_to_search(w, contact);
  int budget = kMaxTestedShapes;
  const bool by_shapes =
      both_dynamic && has_few_shapes(w, contact.body_a, budget) && has_few_shapes(w, contact.body_b, budget);
  if (!by_shapes) {
    const int first = w.bodies[searched_body].first_contact;
    if (first == kNone || w.contacts[first / 2].next[first & 1] == kNone) return;
  }
  const Region<Real> region = region_of(w, contact, manifold, smaller, displacement);
  // Makes the test of `is_attached` for both sides, before anything is computed.
  const auto may_be_attached = [&](int body) {
    return body == contact.body_a || body == contact.body_b || (!both_dynamic && !w.is_dynamic(body));
  };
  const auto visit = [&](int shape, int touched) {
    const int body = w.shapes[shape].body;
    if (!may_be_attached(body) || !w.tight_aabbs[shape].overlaps(region.box) ||
        !is_within_margin(w, shape, region))
      return;
    if (touched != kNone && !w.pairs.contains(shape, touched)) return;
    if (body != contact.body_b) {
      if (!sides.of_a.computed) compute_side(w, contact, false, b_in_a, manifold, sides.of_a);
      test_neighbour(w, sides.of_a, shape);
    }
    if (body != contact.body_a) {
      if (!sides.of_b.computed) compute_side(w, contact, true, b_in_a, manifold, sides.of_b);
      test_neighbour(w, sides.of_b, shape);
    }
  };
  if (by_shapes) {
    for_each_sibling(w, contact, visit);
  } else {
    for_each_touching(w, contact, searched_body, visit);
  }
}

}  // namespace

template <class Real>
ContactManifold<Real> correct_internal_edges(const WorldData<Real>& w, const ContactRecord& contact,
                                             const Pose<Real>& b_in_a, Real margin,
                                             const ContactManifold<Real>& manifold, Real displacement) {
  using Kind = typename InternalEdgeResult<Real>::Kind;
  if (!enabled(Switch::InternalEdges)) return manifold;
  // Only neighbours fixed to a touched shape count. Two dynamic bodies with one shape each have none.
  const auto is_single = [&](int body) {
    const int shape = w.bodies[body].first_shape;
    return shape == kNone || w.shapes[shape].next == kNone;
  };
  const bool both_dynamic = w.is_dynamic(contact.body_a) && w.is_dynamic(contact.body_b);
  if (both_dynamic && is_single(contact.body_a) && is_single(contact.body_b)) return manifold;
  const Real smaller = std::min(w.forms[contact.shape_a].extent, w.forms[contact.shape_b].extent);
  const Real max_width = Real(tuning::kInternalEdgeDepth) * smaller;
  if (is_wide(manifold, max_width)) return manifold;
  Sides<Real> found_sides;
  test_neighbours(w, contact, b_in_a, manifold, smaller, displacement, both_dynamic, found_sides);
  const Side<Real>* const sides[2] = {&found_sides.of_a, &found_sides.of_b};
  if (sides[0]->result.kind == Kind::Hidden || sides[1]->result.kind == Kind::Hidden) return {};
  // Static and kinematic bodies first.
  const int order = !w.is_dynamic(contact.body_a) || w.is_dynamic(contact.body_b) ? 0 : 1;
  for (const int i : {order, 1 - order}) {
    if (sides[i]->result.kind != Kind::Face) continue;
    if (w.is_dynamic(sides[i]->body) && !slides_along(w, contact, *sides[i])) continue;
    const ContactManifold<Real> found = collide_on_face(w, contact, *sides[i], b_in_a, margin);
    if (found.count == 0) {
      // No point is in front of the face: a body inside the shape keeps its contact.
      const bool overlaps = deepest_of(manifold) < -2 * sides[i]->touched.tolerance;
      return overlaps ? manifold : found;
    }
    return deepest_of(found) < -max_width ? manifold : found;
  }
  return manifold;
}

#define PLUMB_FOR(Real)                                                                               \
  template ContactManifold<Real> correct_internal_edges(const WorldData<Real>&, const ContactRecord&, \
                                                        const Pose<Real>&, Real,                      \
                                                        const ContactManifold<Real>&, Real);
PLUMB_FOR(float)
PLUMB_FOR(double)
#undef PLUMB_FOR

}  // namespace plumb
