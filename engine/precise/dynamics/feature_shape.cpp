#include "engine/precise/dynamics/feature_shape.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>

#include "engine/geometry/convex_hull.h"
#include "engine/math/trigonometry.h"

namespace plumb::precise {
namespace {

using Kind = Feature::Kind;

/// Fraction of the scene's extent by which a corner of a polygon has to stand out: 20,000 times the gap that
/// counts as closed (Contacts::update_states). On corners that stand out by a few hundred such gaps a body
/// that lands rocks in impacts too close in time to be told apart, without end. A corner that is dropped
/// stood out by no more than what the errors of a run, 1e-9 of the scene's length, do to it.
constexpr double kDetail = 1e-9;

/// The same as a fraction of the polygon's own extent, for small polygons in large scenes.
constexpr double kLargestDetail = 1e-5;

/// Normals of a chain count as equal if the sine of the angle between them is smaller.
constexpr double kAlike = 1e-12;

Vec2d world(const Pose<double>& pose, Vec2d point) { return pose.position + pose.rotation * point; }

/// A feature relative to its edge: corner and edge in either order are one case.
struct EdgeView {
  const FeatureShape *edge_shape, *corner_shape;
  const Pose<double>*pose_e, *pose_c;
  int edge, corner;
};

EdgeView edge_view(const Feature& f, const FeatureShape& a, const Pose<double>& pose_a, const FeatureShape& b,
                   const Pose<double>& pose_b) {
  if (f.kind == Kind::CornerOfB) return {&a, &b, &pose_a, &pose_b, f.a, f.b};
  return {&b, &a, &pose_b, &pose_a, f.b, f.a};
}

/// Returns the height of a corner over the edge's line, both without their radii, m.
double height(const EdgeView& v, int corner) {
  const Vec2d start = world(*v.pose_e, v.edge_shape->corners[v.edge].point);
  const Vec2d normal = v.pose_e->rotation * v.edge_shape->corners[v.edge].normal;
  return dot(normal, world(*v.pose_c, v.corner_shape->corners[corner].point) - start);
}

double along_edge(const EdgeView& v, int corner) {
  const Vec2d start = world(*v.pose_e, v.edge_shape->corners[v.edge].point);
  const Vec2d direction = perpendicular(v.pose_e->rotation * v.edge_shape->corners[v.edge].normal);
  return dot(direction, world(*v.pose_c, v.corner_shape->corners[corner].point) - start);
}

/// The least height of the corners of `corner_shape` over an edge of `edge_shape`, and that corner.
struct Lowest {
  double height = 0;
  int corner = 0;
};
Lowest lowest_over(const FeatureShape& edge_shape, const Pose<double>& pose_e, int edge,
                   const FeatureShape& corner_shape, const Pose<double>& pose_c) {
  const EdgeView view{&edge_shape, &corner_shape, &pose_e, &pose_c, edge, 0};
  Lowest best{std::numeric_limits<double>::infinity(), 0};
  for (int k = 0; k < corner_shape.count(); ++k) {
    const double h = height(view, k);
    if (h < best.height) best = {h, k};
  }
  return best;
}

struct CornerPair {
  int a = 0, b = 0;
  double distance = std::numeric_limits<double>::infinity();
  Vec2d direction{};
};
CornerPair closest_corners(const FeatureShape& a, const Pose<double>& pose_a, const FeatureShape& b,
                           const Pose<double>& pose_b) {
  CornerPair best;
  double least = std::numeric_limits<double>::infinity();
  Vec2d apart{};
  for (int i = 0; i < a.count(); ++i) {
    for (int j = 0; j < b.count(); ++j) {
      const Vec2d d = world(pose_b, b.corners[j].point) - world(pose_a, a.corners[i].point);
      if (length_squared(d) >= least) continue;
      least = length_squared(d);
      best.a = i, best.b = j;
      apart = d;
    }
  }
  best.distance = std::sqrt(least);
  best.direction = best.distance > 0 ? (1 / best.distance) * apart : Vec2d{1, 0};
  return best;
}

/// Returns the separation of the hulls along a direction from a to b.
double separation_along(Vec2d n, const FeatureShape& a, const Pose<double>& pose_a, const FeatureShape& b,
                        const Pose<double>& pose_b) {
  double far_a = -std::numeric_limits<double>::infinity(), near_b = -far_a;
  for (const Corner<double>& c : a.corners) far_a = std::max(far_a, dot(n, world(pose_a, c.point)));
  for (const Corner<double>& c : b.corners) near_b = std::min(near_b, dot(n, world(pose_b, c.point)));
  return near_b - far_a;
}

template <class Visit>
void for_each_edge(const FeatureShape& a, const FeatureShape& b, const Visit& visit) {
  for (int i = 0; i < a.edges(); ++i) visit(Kind::CornerOfB, i);
  for (int i = 0; i < b.edges(); ++i) visit(Kind::CornerOfA, i);
}

}  // namespace

Feature feature(Feature::Kind kind, int edge, int corner) {
  return kind == Feature::Kind::CornerOfB ? Feature{kind, edge, corner} : Feature{kind, corner, edge};
}

double FeatureShape::edge_length(int edge) const {
  return length(corners[next(edge)].point - corners[edge].point);
}

namespace {

/// Returns the corners of each geometry except chains, in its own frame, and sets its radius.
struct CornersOf {
  double& radius;
  double scene_extent;  // m

  Corners operator()(const Circle& circle) const {
    radius = circle.radius;
    return disc_corner({});
  }
  Corners operator()(const Box& box) const { return box_corners(0.5 * box.width, 0.5 * box.height); }
  Corners operator()(const Capsule& capsule) const {
    radius = capsule.radius;
    return capsule_corners(capsule.start, capsule.end);
  }
  Corners operator()(const Polygon& polygon) const {
    radius = polygon.radius;
    Vec2d lower = polygon.points.front(), upper = lower;
    for (const Vec2d point : polygon.points) {
      lower = {std::min(lower.x, point.x), std::min(lower.y, point.y)};
      upper = {std::max(upper.x, point.x), std::max(upper.y, point.y)};
    }
    const double size = std::max(upper.x - lower.x, upper.y - lower.y);
    return convex_hull(polygon.points, std::min(kDetail * scene_extent, kLargestDetail * size));
  }
  Corners operator()(const Segment& segment) const { return capsule_corners(segment.start, segment.end); }
  Corners operator()(const Chain&) const { return {}; }
};

/// Returns the segments of a chain.
std::vector<FeatureShape> chain_segments(const FeatureShape& common, const Chain& chain,
                                         const Pose<double>& pose) {
  std::vector<FeatureShape> segments;
  const std::size_t points = chain.points.size(), count = chain.closed ? points : points - 1;
  for (std::size_t i = 0; i < count; ++i) {
    FeatureShape& segment = segments.emplace_back(common);
    const Vec2d from = world(pose, chain.points[i]), to = world(pose, chain.points[(i + 1) % points]);
    segment.corners =
        capsule_corners(from, to);  // edge 0 is the front, to the right of the direction of travel
    segment.link.front_only = true;
    segment.link.continues[0] = chain.closed || i > 0;
    segment.link.continues[1] = chain.closed || i + 1 < count;
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (!segments[i].link.continues[1]) continue;
    const Vec2d own = segments[i].corners[0].normal, next = segments[(i + 1) % count].corners[0].normal;
    if (cross(own, next) >= -kAlike) segments[i].link.next_normal = next;
  }
  return segments;
}

}  // namespace

std::vector<FeatureShape> feature_shapes_of(std::size_t body, const Shape& shape, double scene_extent) {
  FeatureShape feature_shape;
  feature_shape.body = body;
  feature_shape.friction = shape.friction;
  feature_shape.restitution = shape.restitution;
  feature_shape.filter = shape.filter;
  const Pose<double> pose{shape.position, shape.angle == 0 ? Rotation<double>{} : rotation_of(shape.angle)};
  std::vector<FeatureShape> result;
  if (const Chain* chain = std::get_if<Chain>(&shape.geometry)) {
    result = chain_segments(feature_shape, *chain, pose);
  } else {
    feature_shape.corners =
        transformed(std::visit(CornersOf{feature_shape.radius, scene_extent}, shape.geometry), pose);
    result = {feature_shape};
  }
  for (FeatureShape& o : result) {
    for (const Corner<double>& c : o.corners) o.extent = std::max(o.extent, length(c.point));
  }
  return result;
}

Gap gap_of(const Feature& f, const FeatureShape& a, const Pose<double>& pose_a, const FeatureShape& b,
           const Pose<double>& pose_b) {
  Gap gap;
  const double radii = a.radius + b.radius;
  if (f.kind == Kind::Corners) {
    const Vec2d from = world(pose_a, a.corners[f.a].point), to = world(pose_b, b.corners[f.b].point);
    const double distance = length(to - from);
    gap.normal = distance > 0 ? (1 / distance) * (to - from) : Vec2d{1, 0};
    gap.value = distance - radii;
    gap.point = to - b.radius * gap.normal;
    return gap;
  }
  const EdgeView view = edge_view(f, a, pose_a, b, pose_b);
  const Vec2d outward = view.pose_e->rotation * view.edge_shape->corners[view.edge].normal;
  gap.normal = f.kind == Kind::CornerOfB ? outward : -outward;
  gap.value = height(view, view.corner) - radii;
  gap.along = along_edge(view, view.corner);
  gap.length = view.edge_shape->edge_length(view.edge);
  gap.point = world(*view.pose_c, view.corner_shape->corners[view.corner].point) -
              view.corner_shape->radius * outward;
  return gap;
}

bool allows_contact(const Feature& f, const Gap& gap, const FeatureShape& a, const Pose<double>& pose_a,
                    const FeatureShape& b, const Pose<double>& pose_b, double tolerance) {
  constexpr double kDeep = 64;
  const auto side = [&](const FeatureShape& o, const Pose<double>& pose, bool edge, int index,
                        Vec2d outward) {
    if (!o.link.front_only) return true;
    if (gap.value < -kDeep * tolerance) return false;
    if (edge) return index == 0;
    if (!o.link.continues[index]) return true;
    if (index == 0 || o.link.next_normal == Vec2d{}) return false;
    const Vec2d own = pose.rotation * o.corners[0].normal, next = pose.rotation * o.link.next_normal;
    return dot(own + next, outward) > 0 && cross(own, outward) >= -kAlike && cross(outward, next) >= -kAlike;
  };
  return side(a, pose_a, f.kind == Kind::CornerOfB, f.a, gap.normal) &&
         side(b, pose_b, f.kind == Kind::CornerOfA, f.b, -gap.normal);
}

// With the normal n, its turning rate W, the contact point p and the bodies' velocities v, w,
//   gap' = n . (vb - va) + wb (p - xb) x n - wa (p - xa) x n,      n' = W t,   t' = -W n,
// and slip the same with t in place of n. p' is the velocity of the contact's corner, including its radius.
ContactRows rows_of(const Feature& f, const FeatureShape& a, const Pose<double>& pose_a,
                    const Twist<double>& twist_a, const FeatureShape& b, const Pose<double>& pose_b,
                    const Twist<double>& twist_b) {
  const Gap gap = gap_of(f, a, pose_a, b, pose_b);
  const Vec2d n = gap.normal, t = perpendicular(n), p = gap.point;
  const auto corner_velocity = [](const FeatureShape& o, int corner, const Pose<double>& pose,
                                  const Twist<double>& twist) {
    return twist.velocity + cross(twist.angular_velocity, pose.rotation * o.corners[corner].point);
  };
  double turning = 0;
  Vec2d p_rate{};
  if (f.kind == Kind::Corners) {
    const Vec2d va = corner_velocity(a, f.a, pose_a, twist_a), vb = corner_velocity(b, f.b, pose_b, twist_b);
    const double distance = gap.value + a.radius + b.radius;
    turning = distance > 0 ? dot(t, vb - va) / distance : 0;
    p_rate = vb - b.radius * turning * t;
  } else if (f.kind == Kind::CornerOfB) {
    turning = twist_a.angular_velocity;
    p_rate = corner_velocity(b, f.b, pose_b, twist_b) - b.radius * turning * t;
  } else {
    turning = twist_b.angular_velocity;
    p_rate = corner_velocity(a, f.a, pose_a, twist_a) + a.radius * turning * t;
  }
  const Vec2d arm_a = p - pose_a.position, arm_b = p - pose_b.position;
  const Vec2d arm_a_rate = p_rate - twist_a.velocity, arm_b_rate = p_rate - twist_b.velocity;
  const auto row = [&](Vec2d u, Vec2d u_rate) {
    Row<double> r;
    r.a = static_cast<int>(a.body), r.b = static_cast<int>(b.body);
    r.linear_a = -u, r.linear_b = u;
    r.angular_a = -cross(arm_a, u), r.angular_b = cross(arm_b, u);
    r.bias_acceleration = dot(u_rate, twist_b.velocity - twist_a.velocity) +
                          twist_b.angular_velocity * (cross(arm_b_rate, u) + cross(arm_b, u_rate)) -
                          twist_a.angular_velocity * (cross(arm_a_rate, u) + cross(arm_a, u_rate));
    return r;
  };
  ContactRows rows{row(n, turning * t), row(t, -turning * n)};
  rows.normal.residual = gap.value;
  return rows;
}

Separation separation(const FeatureShape& a, const Pose<double>& pose_a, const FeatureShape& b,
                      const Pose<double>& pose_b) {
  const double radii = a.radius + b.radius;
  Separation best;
  best.distance = -std::numeric_limits<double>::infinity();
  for_each_edge(a, b, [&](Kind kind, int edge) {
    const bool of_a = kind == Kind::CornerOfB;
    const Lowest low =
        of_a ? lowest_over(a, pose_a, edge, b, pose_b) : lowest_over(b, pose_b, edge, a, pose_a);
    if (low.height - radii <= best.distance) return;
    best.distance = low.height - radii;
    best.feature = feature(kind, edge, low.corner);
  });
  if (best.distance + radii > 0 || (a.edges() == 0 && b.edges() == 0)) {
    const CornerPair corners = closest_corners(a, pose_a, b, pose_b);
    const double apart = separation_along(corners.direction, a, pose_a, b, pose_b) - radii;
    // Sharp corners touch only edges. For two sharp corners this is only a bound on the distance.
    const bool touches = radii == 0 && corners.distance < 1e-9 * (a.extent + b.extent);
    if (apart > best.distance && !touches) {
      best.distance = apart;
      best.feature = {Kind::Corners, corners.a, corners.b};
      best.normal = corners.direction;
      return best;
    }
  }
  best.normal = gap_of(best.feature, a, pose_a, b, pose_b).normal;
  return best;
}

FeatureLimits feature_limits_of(const Feature& f, const FeatureShape& a, const Pose<double>& pose_a,
                                const FeatureShape& b, const Pose<double>& pose_b) {
  FeatureLimits limits;
  if (f.kind == Kind::Corners) {
    // The normal must stay within the cones of both corners: it points away from their neighbours.
    const Vec2d n = gap_of(f, a, pose_a, b, pose_b).normal;
    const auto cone = [&](const FeatureShape& o, int corner, const Pose<double>& pose, Vec2d outward) {
      if (o.count() < 2) return;
      for (const int other : {o.previous(corner), o.next(corner)}) {
        const Vec2d to = pose.rotation * (o.corners[corner].point - o.corners[other].point);
        limits.add(dot(outward, to), false);
        if (o.count() == 2) return;
      }
    };
    cone(a, f.a, pose_a, n);
    cone(b, f.b, pose_b, -n);
    return limits;
  }
  const EdgeView view = edge_view(f, a, pose_a, b, pose_b);
  const double along = along_edge(view, view.corner);
  limits.add(along, false);
  limits.add(view.edge_shape->edge_length(view.edge) - along, false);
  if (view.corner_shape->count() < 2) return limits;
  const double radii = a.radius + b.radius;
  limits.add(height(view, view.corner_shape->previous(view.corner)) - radii, true);
  if (view.corner_shape->count() > 2)
    limits.add(height(view, view.corner_shape->next(view.corner)) - radii, true);
  return limits;
}

}  // namespace plumb::precise
