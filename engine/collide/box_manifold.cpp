#include "engine/collide/hull.h"

namespace plumb::narrow {
namespace {

/// Whether opposite normals of both quadrilaterals are negatives of each other, and none is very oblique:
/// then two axes stand for four edges, and half-diagonals for the corners.
template <class Real>
bool are_boxes(const Corner<Real>* a, const Corner<Real>* b) {
  const auto uneven = [](const Corner<Real>* c) {
    const Vec2<Real> first = c[0].normal + c[2].normal, second = c[1].normal + c[3].normal;
    return (std::fabs(first.x) + std::fabs(first.y)) + (std::fabs(second.x) + std::fabs(second.y));
  };
  const auto oblique = [](const Corner<Real>* c) { return std::fabs(dot(c[0].normal, c[1].normal)); };
  return uneven(a) + uneven(b) <= 8 * std::numeric_limits<Real>::epsilon() &&
         oblique(a) + oblique(b) < Real(0.5);
}

/// A box in a's frame, about the centre of box a.
template <class Real>
struct Box {
  Vec2<Real> diagonal[2];  // from the centre to corners 0 and 1
  Vec2<Real> normal[2];    // of edges 0 and 1
  Real half[2];            // m, from the centre to those edges
};

template <class Real>
Vec2<Real> center_of(const Corner<Real>* c) {
  return Real(0.5) * (c[0].point + c[2].point);
}

/// How far one box is out of another along the two axes of the latter; the greater decides.
template <class Real>
struct BoxFace {
  Real separation;
  int axis;
  bool positive;  // along its normal, or against it
};

template <class Real>
inline BoxFace<Real> farthest_face(const Box<Real>& box, Vec2<Real> to_other, const Box<Real>& other) {
  Real separation[2], way[2];
  for (int k = 0; k < 2; ++k) {
    const Vec2<Real> n = box.normal[k];
    way[k] = dot(n, to_other);
    const Real first = std::fabs(dot(n, other.diagonal[0])), second = std::fabs(dot(n, other.diagonal[1]));
    separation[k] = std::fabs(way[k]) - ((first > second ? first : second) + box.half[k]);
  }
  const int axis = separation[1] > separation[0] ? 1 : 0;
  return {separation[axis], axis, way[axis] >= 0};
}

/// The ends of an edge from the centre, counter-clockwise, and their indices.
template <class Real>
inline void set_edge(const Box<Real>& box, int axis, bool positive, Vec2<Real> center, Vec2<Real> (&ends)[2],
                     int (&ids)[2]) {
  const Vec2<Real> first = axis == 0 ? box.diagonal[0] : box.diagonal[1];
  const Vec2<Real> second = axis == 0 ? box.diagonal[1] : -box.diagonal[0];
  ends[0] = positive ? center + first : center - first;
  ends[1] = positive ? center + second : center - second;
  ids[0] = positive ? axis : axis + 2;
  ids[1] = (ids[0] + 1) & 3;
}

template <class Real>
inline FacingEdges<Real> facing_edges(const Box<Real>& box, const BoxFace<Real>& face, Vec2<Real> center,
                                      const Box<Real>& other, Vec2<Real> other_center) {
  FacingEdges<Real> out;
  const Vec2<Real> axis = box.normal[face.axis];
  out.normal = face.positive ? axis : -axis;
  set_edge(box, face.axis, face.positive, center, out.reference, out.reference_id);
  const Real along_0 = dot(out.normal, other.normal[0]), along_1 = dot(out.normal, other.normal[1]);
  const int incident = std::fabs(along_1) > std::fabs(along_0) ? 1 : 0;
  set_edge(other, incident, (incident == 0 ? along_0 : along_1) < 0, other_center, out.incident,
           out.incident_id);
  return out;
}

/// Whether the reference edge's normal is the right one for boxes that are apart: the nearest corner lies
/// over the edge, or the edges lie flat on each other.
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

}  // namespace

template <class Real>
ContactManifold<Real> collide_boxes(const Convex<Real>& a, const Convex<Real>& b, const Pose<Real>& b_in_a,
                                    Real reach) {
  const Corner<Real>*corners_a = a.corners, *corners_b = b.corners;
  if (!are_boxes(corners_a, corners_b)) return collide_polygons(a, b, b_in_a, reach);
  const Rotation<Real> q = b_in_a.rotation;
  const Vec2<Real> center_a = center_of(corners_a), center_b = center_of(corners_b);
  const Vec2<Real> way = (b_in_a.position - center_a) + q * center_b;
  const Real limit = reach + a.radius + b.radius;

  Box<Real> box_a, box_b;
  for (int k = 0; k < 2; ++k) {
    box_a.diagonal[k] = corners_a[k].point - center_a;
    box_a.normal[k] = corners_a[k].normal;
    box_a.half[k] = dot(box_a.normal[k], box_a.diagonal[k]);
    const Vec2<Real> diagonal_b = corners_b[k].point - center_b;
    box_b.half[k] = dot(corners_b[k].normal, diagonal_b);
    box_b.diagonal[k] = q * diagonal_b;
  }
  const BoxFace<Real> of_a = farthest_face(box_a, way, box_b);
  if (of_a.separation > limit) return {};
  for (int k = 0; k < 2; ++k) box_b.normal[k] = q * corners_b[k].normal;
  const BoxFace<Real> of_b = farthest_face(box_b, -way, box_a);
  if (of_b.separation > limit) return {};

  const Real size_a = box_a.half[0] + box_a.half[1], size_b = box_b.half[0] + box_b.half[1];
  const Real preference = Real(2 * kPreference) * (size_a < size_b ? size_a : size_b);
  const bool use_b = of_b.separation > of_a.separation + preference;
  FacingEdges<Real> edges = use_b ? facing_edges(box_b, of_b, way, box_a, Vec2<Real>{})
                                  : facing_edges(box_a, of_a, Vec2<Real>{}, box_b, way);
  edges.reference_radius = use_b ? b.radius : a.radius;
  edges.incident_radius = use_b ? a.radius : b.radius;
  edges.reference_is_b = use_b;
  const bool apart = of_a.separation > 0 || of_b.separation > 0;
  // Corner near corner is rare enough for the general way.
  if (apart && !over_edge(edges)) return collide_polygons(a, b, b_in_a, reach);
  const ContactManifold<Real> out = clip(edges, reach, center_a);
  if (out.count == 0 && !apart) return collide_polygons(a, b, b_in_a, reach);
  return out;
}

template ContactManifold<float> collide_boxes(const Convex<float>&, const Convex<float>&, const Pose<float>&,
                                              float);
template ContactManifold<double> collide_boxes(const Convex<double>&, const Convex<double>&,
                                               const Pose<double>&, double);

}  // namespace plumb::narrow
