#include "engine/world/queries.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/collision/distance/hull_distance.h"
#include "engine/collision/distance/ray_cast.h"
#include "engine/collision/distance/shape_cast.h"
#include "engine/geometry/convex_bounds.h"
#include "engine/math/trigonometry.h"
#include "engine/scene/error.h"
#include "engine/world/queries/transformed_shape.h"
#include "engine/world/state/lock.h"
#include "engine/world/state/validate.h"

namespace plumb {
namespace {

bool is_finite(double v) { return std::abs(v) <= kLargestNumber; }

// Builds names only for errors.
void check(const char* query, const char* field, Vec2d v) {
  if (!is_finite(v.x) || !is_finite(v.y)) require_finite(query, field, v);
}
void check(const char* query, const char* field, double v) {
  if (!is_finite(v)) require_finite(query, field, v);
}

double l1_norm(Vec2d v) { return std::abs(v.x) + std::abs(v.y); }

template <class Real>
ShapeId shape_id(const WorldData<Real>& w, int shape) {
  return {static_cast<std::uint32_t>(shape), w.shapes.generation(shape)};
}

template <class Real>
BodyId body_id(const WorldData<Real>& w, int shape) {
  const int body = w.shapes[shape].body;
  return {static_cast<std::uint32_t>(body), w.bodies.generation(body)};
}

template <class Real>
bool passes_filter(const WorldData<Real>& w, int shape, const QueryFilter& filter) {
  const ShapeRecord<Real>& record = w.shapes[shape];
  if ((record.filter.category & filter.mask) == 0 || (record.filter.mask & filter.category) == 0)
    return false;
  if (w.forms[shape].sensor && !filter.sensors) return false;
  if (static_cast<std::uint32_t>(record.body) == filter.ignore.index && body_id(w, shape) == filter.ignore)
    return false;
  return filter.condition(shape_id(w, shape));
}

// Returns the margin, m, by which to grow a query so that it overlaps the fat AABB of every shape that it
// hits. Fat AABBs contain the shapes after rounding to Real (of position, rotated corners, their sum and the
// radius). These errors are below 2 epsilon of the coordinates plus 3 epsilon of the body's size; the size of
// the tree is a bound for both. The query's own numbers are rounded by less than epsilon of themselves.
template <class Real>
double rounding_margin(const WorldData<Real>& w, double magnitude) {
  double size = 0;
  for (const DynamicTree<Real>* tree : {&w.static_tree, &w.dynamic_tree}) {
    const Aabb<Real> bounds = tree->bounds();
    size = std::max(size, l1_norm((bounds.upper - bounds.lower).template as<double>()));
  }
  return 4 * static_cast<double>(std::numeric_limits<Real>::epsilon()) * (magnitude + size);
}

// Returns `value` >= 0 as a Real, rounded up.
template <class Real>
Real rounded_up(double value) {
  return static_cast<Real>(value * (1 + 2 * static_cast<double>(std::numeric_limits<Real>::epsilon()))) +
         std::numeric_limits<Real>::min();
}

// Calls visit(shape) -> bool for shapes whose fat AABBs may overlap `box`, until it returns false.
template <class Real, class Visit>
void query_aabb(const WorldData<Real>& w, const Aabb<double>& box, const QueryFilter& filter,
                const Visit& visit) {
  const double margin = rounding_margin(w, std::max(l1_norm(box.lower), l1_norm(box.upper)));
  const Aabb<double> grown = box.grown(margin);
  const Aabb<Real> rounded{grown.lower.as<Real>(), grown.upper.as<Real>()};
  bool proceed = true;
  const auto visit_leaf = [&](int shape, int) {
    proceed = !passes_filter(w, shape, filter) || visit(shape);
    return proceed;
  };
  w.static_tree.query(rounded, folded(filter.mask), visit_leaf);
  if (proceed) w.dynamic_tree.query(rounded, folded(filter.mask), visit_leaf);
}

// Sweeps a box around `start` by `translation`. Calls visit(shape, limit) -> new limit for shapes whose fat
// AABBs may be hit before the smallest fraction returned so far, `limit`; stops at 0.
template <class Real, class Visit>
void cast_aabb(const WorldData<Real>& w, Vec2d start, Vec2d translation, Vec2d half,
               const QueryFilter& filter, const Visit& visit) {
  const double margin = rounding_margin(w, l1_norm(start) + l1_norm(translation) + l1_norm(half));
  const Vec2<Real> half_extent = (half + Vec2d{margin, margin}).as<Real>();
  double limit = 1;
  const auto visit_leaf = [&](int shape, Real) -> Real {
    if (passes_filter(w, shape, filter)) limit = std::min(limit, visit(shape, limit));
    return limit > 0 ? rounded_up<Real>(limit) : Real(0);
  };
  w.static_tree.ray_cast(start.as<Real>(), translation.as<Real>(), half_extent, folded(filter.mask),
                         visit_leaf);
  if (!(limit > 0)) return;
  w.dynamic_tree.ray_cast(start.as<Real>(), translation.as<Real>(), half_extent, folded(filter.mask),
                          visit_leaf);
}

// Keeps the first hit: the smallest fraction, then the smallest shape index.
template <class Result>
struct Closest {
  std::optional<Result> best{};
  double operator()(const Result& hit) {
    const bool first = !best || hit.fraction < best->fraction ||
                       (hit.fraction == best->fraction && hit.shape.index < best->shape.index);
    if (first) best = hit;
    // Never return 0, which would stop the cast before it finds other hits at the same fraction.
    return std::max(best->fraction, std::numeric_limits<double>::min());
  }
};

// Returns the front direction of a chain's segment: to the right of its direction.
Vec2d front_direction(const Convex<double>& segment) {
  return -perpendicular(segment.corners[1].point - segment.corners[0].point);
}

// A shape with rotated corners, relative to its own position.
class RotatedShape {
 public:
  RotatedShape(const QueryShape& shape, double angle) : shape_(shape), pose_{{}, rotation_of(angle)} {}
  Convex<double> convex() const { return shape_.convex(); }
  const Pose<double>& pose() const { return pose_; }
  Vec2d middle() const { return pose_.rotation * shape_.middle(); }
  Aabb<double> bounds() const { return convex_bounds(shape_.convex(), pose_); }

 private:
  const QueryShape& shape_;
  Pose<double> pose_;
};

CastResult<double> cast_against(const Convex<double>& target, bool chain, const RotatedShape& moving,
                                Vec2d translation) {
  const Vec2d front = chain ? front_direction(target) : Vec2d{};
  if (chain && !(dot(front, moving.middle() - target.corners[0].point) > 0)) return {};
  return shape_cast(target, moving.convex(), moving.pose(), translation, front);
}

void sort_by_index(std::vector<ShapeId>& shapes) {
  std::sort(shapes.begin(), shapes.end(), [](ShapeId a, ShapeId b) { return a.index < b.index; });
}

// Runs a query with a visitor that collects shapes.
template <class Query>
void collect(std::vector<ShapeId>& found, const Query& query) {
  found.clear();
  const auto add = [&](ShapeId shape) {
    found.push_back(shape);
    return true;
  };
  query(VisitShape(add));
  sort_by_index(found);
}

template <class Real>
void overlap_at_pose(const WorldData<Real>& w, const QueryShape& shape, Vec2d position, double angle,
                     const QueryFilter& filter, const VisitShape& visit) {
  const RotatedShape rotated(shape, angle);
  const Aabb<double> bounds = rotated.bounds();
  query_aabb(w, {position + bounds.lower, position + bounds.upper}, filter, [&](int other) {
    const TransformedShape target(w, other, position);
    const Convex<double> a = target.convex(), b = rotated.convex();
    const bool overlaps = hull_distance(a, b, rotated.pose(), nullptr).separation <= a.radius + b.radius;
    return !overlaps || visit(shape_id(w, other));
  });
}

// Returns an upper bound of the distance, m, by which rounding displaces a body's corners and a ray: corners
// are stored in Real, rotated by a rotation in Real, and added to a position in double. Seams of shapes that
// are placed side by side gape by up to the sum of both bounds.
template <class Real>
double ray_rounding(const WorldData<Real>& w, int body, Vec2d origin, Vec2d translation) {
  constexpr double kReal = std::numeric_limits<Real>::epsilon(),
                   kDouble = std::numeric_limits<double>::epsilon();
  return 4 * kReal * static_cast<double>(w.extents[body]) +
         4 * kDouble * (l1_norm(w.position[body]) + l1_norm(origin) + l1_norm(translation));
}

// Casts a ray at one shape, up to a fraction.
template <class Real>
std::optional<RayResult> ray_cast_shape(const WorldData<Real>& w, int shape, Vec2d origin, Vec2d translation,
                                        double limit) {
  const TransformedShape target(w, shape, origin);
  const double tolerance = ray_rounding(w, w.shapes[shape].body, origin, translation);
  const RayHit<double> hit = w.forms[shape].chain
                                 ? ray_cast_one_sided(target.convex(), Vec2d{}, translation, tolerance)
                                 : ray_cast(target.convex(), Vec2d{}, translation, tolerance);
  if (!hit.hit || hit.fraction > limit) return std::nullopt;
  return RayResult{shape_id(w, shape), body_id(w, shape), hit.fraction, origin + hit.point, hit.normal};
}

template <class Real, class Visit>
void visit_ray(const WorldData<Real>& w, Vec2d origin, Vec2d translation, const QueryFilter& filter,
               Visit&& visit) {
  check("ray", "origin", origin);
  check("ray", "translation", translation);
  cast_aabb(w, origin, translation, {}, filter, [&](int shape, double limit) {
    const std::optional<RayResult> hit = ray_cast_shape(w, shape, origin, translation, limit);
    return hit ? visit(*hit) : limit;
  });
}

template <class Real, class Visit>
void visit_cast(const WorldData<Real>& w, const QueryShape& shape, Vec2d position, double angle,
                Vec2d translation, const QueryFilter& filter, Visit&& visit) {
  check("cast", "position", position);
  check("cast", "angle", angle);
  check("cast", "translation", translation);
  const RotatedShape rotated(shape, angle);
  const Aabb<double> box = rotated.bounds();
  const Vec2d centre = 0.5 * (box.lower + box.upper), half = 0.5 * (box.upper - box.lower);
  cast_aabb(w, position + centre, translation, half, filter, [&](int other, double limit) {
    const TransformedShape target(w, other, position);
    const CastResult<double> hit = cast_against(target.convex(), w.forms[other].chain, rotated, translation);
    if (!hit.hit || hit.fraction > limit) return limit;
    return visit(CastShapeResult{shape_id(w, other), body_id(w, other), hit.fraction, position + hit.point,
                                 hit.normal, hit.overlapped});
  });
}

template <class Real>
void visit_overlaps(const WorldData<Real>& w, const QueryShape& shape, Vec2d position, double angle,
                    const QueryFilter& filter, const VisitShape& visit) {
  check("overlap", "position", position);
  check("overlap", "angle", angle);
  overlap_at_pose(w, shape, position, angle, filter, visit);
}

template <class Real>
void visit_overlaps(const WorldData<Real>& w, const Aabb<double>& box, const QueryFilter& filter,
                    const VisitShape& visit) {
  check("overlap", "lower", box.lower);
  check("overlap", "upper", box.upper);
  const Vec2d half = 0.5 * (box.upper - box.lower);
  if (!(half.x >= 0)) require_not_negative("overlap", "width", 2 * half.x);
  if (!(half.y >= 0)) require_not_negative("overlap", "height", 2 * half.y);
  overlap_at_pose(w, QueryShape::box(half.x, half.y), box.lower + half, 0, filter, visit);
}

template <class Real>
void visit_shapes_at(const WorldData<Real>& w, Vec2d point, const QueryFilter& filter,
                     const VisitShape& visit) {
  check("shapes_at", "point", point);
  query_aabb(w, {point, point}, filter, [&](int shape) {
    const TransformedShape target(w, shape, point);
    return !contains(target.convex(), Vec2d{}) || visit(shape_id(w, shape));
  });
}

}  // namespace

template <class Real>
std::optional<RayResult> ray_cast_closest(const BasicWorld<Real>& world, Vec2d origin, Vec2d translation,
                                          const QueryFilter& filter) {
  Closest<RayResult> closest;
  const Lock<Real> lock(world.data(), filter.condition.asks());
  visit_ray(world.data(), origin, translation, filter, closest);
  return closest.best;
}

template <class Real>
void ray_cast(const BasicWorld<Real>& world, Vec2d origin, Vec2d translation, const QueryFilter& filter,
              VisitRay visit) {
  const Lock<Real> lock(world.data());
  visit_ray(world.data(), origin, translation, filter, visit);
}

template <class Real>
void ray_cast_all(const BasicWorld<Real>& world, Vec2d origin, Vec2d translation, const QueryFilter& filter,
                  std::vector<RayResult>& hits) {
  hits.clear();
  const Lock<Real> lock(world.data(), filter.condition.asks());
  visit_ray(world.data(), origin, translation, filter, [&](const RayResult& hit) {
    hits.push_back(hit);
    return 1.0;
  });
  std::sort(hits.begin(), hits.end(), [](const RayResult& a, const RayResult& b) {
    return a.fraction != b.fraction ? a.fraction < b.fraction : a.shape.index < b.shape.index;
  });
}

template <class Real>
std::optional<CastShapeResult> cast_shape_closest(const BasicWorld<Real>& world, const QueryShape& shape,
                                                  Vec2d position, double angle, Vec2d translation,
                                                  const QueryFilter& filter) {
  Closest<CastShapeResult> closest;
  const Lock<Real> lock(world.data(), filter.condition.asks());
  visit_cast(world.data(), shape, position, angle, translation, filter, closest);
  return closest.best;
}

template <class Real>
void cast_shape(const BasicWorld<Real>& world, const QueryShape& shape, Vec2d position, double angle,
                Vec2d translation, const QueryFilter& filter, VisitCast visit) {
  const Lock<Real> lock(world.data());
  visit_cast(world.data(), shape, position, angle, translation, filter, visit);
}

template <class Real>
void overlap_shape(const BasicWorld<Real>& world, const QueryShape& shape, Vec2d position, double angle,
                   const QueryFilter& filter, VisitShape visit) {
  const Lock<Real> lock(world.data());
  visit_overlaps(world.data(), shape, position, angle, filter, visit);
}

template <class Real>
void overlap_shape(const BasicWorld<Real>& world, const QueryShape& shape, Vec2d position, double angle,
                   const QueryFilter& filter, std::vector<ShapeId>& found) {
  const Lock<Real> lock(world.data(), filter.condition.asks());
  collect(found,
          [&](VisitShape visit) { visit_overlaps(world.data(), shape, position, angle, filter, visit); });
}

template <class Real>
void overlap_box(const BasicWorld<Real>& world, const Aabb<double>& box, const QueryFilter& filter,
                 VisitShape visit) {
  const Lock<Real> lock(world.data());
  visit_overlaps(world.data(), box, filter, visit);
}

template <class Real>
void overlap_box(const BasicWorld<Real>& world, const Aabb<double>& box, const QueryFilter& filter,
                 std::vector<ShapeId>& found) {
  const Lock<Real> lock(world.data(), filter.condition.asks());
  collect(found, [&](VisitShape visit) { visit_overlaps(world.data(), box, filter, visit); });
}

template <class Real>
void shapes_at(const BasicWorld<Real>& world, Vec2d point, const QueryFilter& filter, VisitShape visit) {
  const Lock<Real> lock(world.data());
  visit_shapes_at(world.data(), point, filter, visit);
}

template <class Real>
void shapes_at(const BasicWorld<Real>& world, Vec2d point, const QueryFilter& filter,
               std::vector<ShapeId>& found) {
  const Lock<Real> lock(world.data(), filter.condition.asks());
  collect(found, [&](VisitShape visit) { visit_shapes_at(world.data(), point, filter, visit); });
}

template <class Real>
std::optional<NearestResult> nearest(const BasicWorld<Real>& world, Vec2d point, double max_distance,
                                     const QueryFilter& filter) {
  check("nearest", "point", point);
  if (!(max_distance >= 0)) require_not_negative("nearest", "max_distance", max_distance);
  const WorldData<Real>& w = world.data();
  const Lock<Real> lock(w, filter.condition.asks());
  double limit = std::min(max_distance, 4 * kLargestNumber);  // no shape is farther away
  const double margin = rounding_margin(w, l1_norm(point));
  std::optional<NearestResult> best;
  const auto visit_leaf = [&](int shape, Real) {
    if (passes_filter(w, shape, filter)) {
      const TransformedShape target(w, shape, point);
      const SurfacePoint<double> at = nearest_point(target.convex(), Vec2d{});
      const bool first =
          best ? at.distance < best->distance ||
                     (at.distance == best->distance && static_cast<std::uint32_t>(shape) < best->shape.index)
               : at.distance <= limit;
      if (first) {
        best = {shape_id(w, shape), body_id(w, shape), point + at.point, at.normal, at.distance};
        limit = std::max(at.distance, 0.0);
      }
    }
    return rounded_up<Real>(limit + 2 * margin);
  };
  const Vec2<Real> from = point.as<Real>();
  w.static_tree.nearest(from, folded(filter.mask), rounded_up<Real>(limit + 2 * margin), visit_leaf);
  w.dynamic_tree.nearest(from, folded(filter.mask), rounded_up<Real>(limit + 2 * margin), visit_leaf);
  return best;
}

template <class Real>
ShapeDistance distance(const BasicWorld<Real>& world, ShapeId a, ShapeId b) {
  world.body(a), world.body(b);  // throw for handles of destroyed shapes
  const WorldData<Real>& w = world.data();
  const int shape_a = static_cast<int>(a.index), shape_b = static_cast<int>(b.index);
  const Vec2d origin = w.position[w.shapes[shape_a].body];
  const TransformedShape transformed_a(w, shape_a, origin), transformed_b(w, shape_b, origin);
  const Convex<double> convex_a = transformed_a.convex(), convex_b = transformed_b.convex();
  const HullDistance hulls = hull_distance(convex_a, convex_b, Pose<double>{}, nullptr);
  return {origin + hulls.point_a + convex_a.radius * hulls.normal,
          origin + hulls.point_b - convex_b.radius * hulls.normal, hulls.normal,
          hulls.separation - (convex_a.radius + convex_b.radius)};
}

template <class Real>
std::optional<RayResult> ray_cast(const BasicWorld<Real>& world, ShapeId shape, Vec2d origin,
                                  Vec2d translation) {
  world.body(shape);  // throws for the handle of a destroyed shape
  check("ray", "origin", origin);
  check("ray", "translation", translation);
  return ray_cast_shape(world.data(), static_cast<int>(shape.index), origin, translation, 1);
}
template <class Real>
bool contains(const BasicWorld<Real>& world, ShapeId shape, Vec2d point) {
  world.body(shape);  // throws for the handle of a destroyed shape
  check("contains", "point", point);
  const TransformedShape target(world.data(), static_cast<int>(shape.index), point);
  return contains(target.convex(), Vec2d{});
}

#define PLUMB_FOR(Real)                                                                                      \
  template std::optional<RayResult> ray_cast_closest(const BasicWorld<Real>&, Vec2d, Vec2d,                  \
                                                     const QueryFilter&);                                    \
  template void ray_cast(const BasicWorld<Real>&, Vec2d, Vec2d, const QueryFilter&, VisitRay);               \
  template void ray_cast_all(const BasicWorld<Real>&, Vec2d, Vec2d, const QueryFilter&,                      \
                             std::vector<RayResult>&);                                                       \
  template std::optional<CastShapeResult> cast_shape_closest(const BasicWorld<Real>&, const QueryShape&,     \
                                                             Vec2d, double, Vec2d, const QueryFilter&);      \
  template void cast_shape(const BasicWorld<Real>&, const QueryShape&, Vec2d, double, Vec2d,                 \
                           const QueryFilter&, VisitCast);                                                   \
  template void overlap_shape(const BasicWorld<Real>&, const QueryShape&, Vec2d, double, const QueryFilter&, \
                              VisitShape);                                                                   \
  template void overlap_shape(const BasicWorld<Real>&, const QueryShape&, Vec2d, double, const QueryFilter&, \
                              std::vector<ShapeId>&);                                                        \
  template void overlap_box(const BasicWorld<Real>&, const Aabb<double>&, const QueryFilter&, VisitShape);   \
  template void overlap_box(const BasicWorld<Real>&, const Aabb<double>&, const QueryFilter&,                \
                            std::vector<ShapeId>&);                                                          \
  template void shapes_at(const BasicWorld<Real>&, Vec2d, const QueryFilter&, VisitShape);                   \
  template void shapes_at(const BasicWorld<Real>&, Vec2d, const QueryFilter&, std::vector<ShapeId>&);        \
  template std::optional<NearestResult> nearest(const BasicWorld<Real>&, Vec2d, double, const QueryFilter&); \
  template std::optional<RayResult> ray_cast(const BasicWorld<Real>&, ShapeId, Vec2d, Vec2d);                \
  template bool contains(const BasicWorld<Real>&, ShapeId, Vec2d);                                           \
  template ShapeDistance distance(const BasicWorld<Real>&, ShapeId, ShapeId);
PLUMB_FOR(float)
PLUMB_FOR(double)
#undef PLUMB_FOR

}  // namespace plumb
