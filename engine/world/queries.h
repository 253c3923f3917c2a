#pragma once

#include <optional>
#include <vector>

#include "engine/geometry/aabb.h"
#include "engine/world/queries/query_filter.h"
#include "engine/world/state/query_shape.h"
#include "engine/world/world.h"

/// Queries of a world between its steps: ray casts, shape casts, overlaps, nearest shapes. They change
/// nothing, may run in parallel with each other, and allocate only in vectors passed to them. SI units.
/// Geometry is computed in double precision relative to the query's position, so results far from the origin
/// are as accurate as at the origin.
/// Visitors and conditions of filters may read the world; a call that would change it throws Error
/// (Unsupported). An exception thrown by one of them ends the query.
/// Functions throw Error (Value) for numbers that are not finite or exceed 1e12 in magnitude (also in the
/// translation of a ray), and Error (Name) for handles of destroyed objects. They exist for BasicWorld<float>
/// and BasicWorld<double>.
namespace plumb {

/// Hit of a ray: the point at which it enters a shape.
struct RayResult {
  ShapeId shape{};
  BodyId body{};
  double fraction = 1;  ///< of the translation, 0 .. 1
  Vec2d point{};        ///< m, on the surface
  Vec2d normal{};       ///< unit, outward
};

/// Hit of a moving shape: its first contact with another one.
struct CastShapeResult {
  ShapeId shape{};
  BodyId body{};
  double fraction = 1;      ///< of the translation, 0 .. 1
  Vec2d point{};            ///< m, on the surface of the shape hit
  Vec2d normal{};           ///< unit, outward from the shape hit
  bool overlapped = false;  ///< they overlap at the start: fraction 0, normal of least penetration
};

struct NearestResult {
  ShapeId shape{};
  BodyId body{};
  Vec2d point{};        ///< m, on the surface
  Vec2d normal{};       ///< unit, outward
  double distance = 0;  ///< m; negative: depth of the point inside the shape
};

/// Distance between two shapes.
struct ShapeDistance {
  Vec2d point_a{}, point_b{};  ///< m, nearest (or deepest) points on the surfaces
  Vec2d normal{};              ///< unit, from a to b
  double distance = 0;         ///< m, negative: the least translation that separates them
};

/// Visitors of rays and casts return the fraction of the translation up to which the search continues: 1
/// ignores the hit, hit.fraction excludes farther hits, 0 stops. Hits come in an order that depends only on
/// the world's history; they are not sorted by fraction.
using VisitRay = FunctionRef<double(const RayResult& hit)>;
using VisitCast = FunctionRef<double(const CastShapeResult& hit)>;
/// Return false to stop.
using VisitShape = FunctionRef<bool(ShapeId shape)>;

/// Casts a ray from `origin` by `translation`, m. Ignores a shape that contains the start, and chain segments
/// hit from behind. Of hits at equal fraction returns the shape with the smallest index.
template <class Real>
std::optional<RayResult> ray_cast_closest(const BasicWorld<Real>& world, Vec2d origin, Vec2d translation,
                                          const QueryFilter& filter = {});
template <class Real>
void ray_cast(const BasicWorld<Real>& world, Vec2d origin, Vec2d translation, const QueryFilter& filter,
              VisitRay visit);
/// Returns all hits, sorted by fraction, then by shape index; `hits` is cleared first.
template <class Real>
void ray_cast_all(const BasicWorld<Real>& world, Vec2d origin, Vec2d translation, const QueryFilter& filter,
                  std::vector<RayResult>& hits);

/// Casts a shape at `position` with `angle` (rad) by `translation`, m, without rotation. Shapes that touch
/// and separate, or slide along each other, do not hit. A chain's segment is hit only by shapes that start
/// with their centre in front of it, and only with a normal towards its front.
template <class Real>
std::optional<CastShapeResult> cast_shape_closest(const BasicWorld<Real>& world, const QueryShape& shape,
                                                  Vec2d position, double angle, Vec2d translation,
                                                  const QueryFilter& filter = {});
template <class Real>
void cast_shape(const BasicWorld<Real>& world, const QueryShape& shape, Vec2d position, double angle,
                Vec2d translation, const QueryFilter& filter, VisitCast visit);

/// Finds shapes that overlap or touch a shape at a given pose. Segments of chains are found from both sides.
/// The vectors are cleared first; the results are sorted by shape index.
template <class Real>
void overlap_shape(const BasicWorld<Real>& world, const QueryShape& shape, Vec2d position, double angle,
                   const QueryFilter& filter, VisitShape visit);
template <class Real>
void overlap_shape(const BasicWorld<Real>& world, const QueryShape& shape, Vec2d position, double angle,
                   const QueryFilter& filter, std::vector<ShapeId>& found);
/// Does the same for an axis-aligned box; lower <= upper. Tests the shapes themselves, not their AABBs.
template <class Real>
void overlap_box(const BasicWorld<Real>& world, const Aabb<double>& box, const QueryFilter& filter,
                 VisitShape visit);
template <class Real>
void overlap_box(const BasicWorld<Real>& world, const Aabb<double>& box, const QueryFilter& filter,
                 std::vector<ShapeId>& found);

/// Finds shapes that contain `point`, inside or on their surface.
template <class Real>
void shapes_at(const BasicWorld<Real>& world, Vec2d point, const QueryFilter& filter, VisitShape visit);
template <class Real>
void shapes_at(const BasicWorld<Real>& world, Vec2d point, const QueryFilter& filter,
               std::vector<ShapeId>& found);

/// Returns the shape whose surface is nearest to `point` within `max_distance` (m, >= 0). If the point is
/// inside shapes, returns the one in which it is deepest. Of equally near shapes, returns the one with the
/// smallest index.
template <class Real>
std::optional<NearestResult> nearest(const BasicWorld<Real>& world, Vec2d point, double max_distance,
                                     const QueryFilter& filter = {});

/// Casts a ray at one given shape of any kind, without a filter.
template <class Real>
std::optional<RayResult> ray_cast(const BasicWorld<Real>& world, ShapeId shape, Vec2d origin,
                                  Vec2d translation);
/// Returns true if a shape contains `point`, m, inside or on its surface.
template <class Real>
bool contains(const BasicWorld<Real>& world, ShapeId shape, Vec2d point);

/// Returns the distance of any two shapes, including sensors and shapes of one body.
template <class Real>
ShapeDistance distance(const BasicWorld<Real>& world, ShapeId a, ShapeId b);

}  // namespace plumb
