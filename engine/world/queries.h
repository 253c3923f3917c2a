#pragma once

#include <optional>
#include <vector>

#include "engine/geometry/aabb.h"
#include "engine/world/query_filter.h"
#include "engine/world/query_shape.h"
#include "engine/world/world.h"

/// Questions to a world, between its steps: what a ray or a moving shape meets, what lies in a place, what is
/// nearest. They change nothing, may run at the same time as each other, and allocate only in vectors that
/// are handed to them. SI units; geometry is computed in double precision, seen from the query's own place,
/// so that an answer far from the origin is as good as one at the origin.
///
/// Visitors and conditions of filters may look at the world; from there a call that would change it throws
/// Error (Unsupported). What they throw themselves ends the query.
///
/// Functions throw Error (Value) for numbers that are not finite, and Error (Name) for handles of what is
/// gone. Exist for BasicWorld<float> and BasicWorld<double>.
namespace plumb {

/// Where a ray enters a shape.
struct RayResult {
  ShapeId shape{};
  BodyId body{};
  double fraction = 1;  ///< of the translation, 0 .. 1
  Vec2d point{};        ///< m, on the surface
  Vec2d normal{};       ///< unit, outward
};

/// Where a moving shape first touches another one.
struct CastShapeResult {
  ShapeId shape{};
  BodyId body{};
  double fraction = 1;      ///< of the translation, 0 .. 1
  Vec2d point{};            ///< m, on the surface of the shape met
  Vec2d normal{};           ///< unit, outward from the shape met
  bool overlapped = false;  ///< they overlap before the motion: fraction 0, normal the least way out
};

struct NearestResult {
  ShapeId shape{};
  BodyId body{};
  Vec2d point{};        ///< m, on the surface
  Vec2d normal{};       ///< unit, outward
  double distance = 0;  ///< m, negative: the point is that deep inside
};

/// How two shapes lie to each other.
struct ShapeDistance {
  Vec2d point_a{}, point_b{};  ///< m, nearest (or deepest) points on the surfaces
  Vec2d normal{};              ///< unit, from a to b
  double distance = 0;         ///< m, negative: the least translation that parts them
};

/// The visitors of rays and casts return up to which fraction of the translation to look on: 1 to go on (the
/// hit is ignored), hit.fraction for nothing farther than this hit, 0 to stop. Hits come in an order that
/// depends on the world's past alone, not sorted by fraction.
using VisitRay = FunctionRef<double(const RayResult& hit)>;
using VisitCast = FunctionRef<double(const CastShapeResult& hit)>;
/// Returns false to stop.
using VisitShape = FunctionRef<bool(ShapeId shape)>;

/// A ray from `origin` by `translation`, m. It does not see a shape that it starts in, nor segments of chains
/// from behind. Of hits at one fraction the closest is that of the smaller shape index.
template <class Real>
std::optional<RayResult> ray_cast_closest(const BasicWorld<Real>& world, Vec2d origin, Vec2d translation,
                                          const QueryFilter& filter = {});
template <class Real>
void ray_cast(const BasicWorld<Real>& world, Vec2d origin, Vec2d translation, const QueryFilter& filter,
              VisitRay visit);
/// All hits, sorted by fraction, then by shape index; `hits` is cleared first.
template <class Real>
void ray_cast_all(const BasicWorld<Real>& world, Vec2d origin, Vec2d translation, const QueryFilter& filter,
                  std::vector<RayResult>& hits);

/// A shape whose frame lies at `position` with `angle` (rad), moved by `translation`, m, without turning.
/// Shapes that touch and part, or slide along each other, do not hit. A chain's segment is met only by what
/// starts with its middle in front of it, and with a normal that points to its front.
template <class Real>
std::optional<CastShapeResult> cast_shape_closest(const BasicWorld<Real>& world, const QueryShape& shape,
                                                  Vec2d position, double angle, Vec2d translation,
                                                  const QueryFilter& filter = {});
template <class Real>
void cast_shape(const BasicWorld<Real>& world, const QueryShape& shape, Vec2d position, double angle,
                Vec2d translation, const QueryFilter& filter, VisitCast visit);

/// Shapes that overlap or touch a shape at a place; segments of chains from both sides. Vectors are cleared
/// first, and sorted by shape index.
template <class Real>
void overlap_shape(const BasicWorld<Real>& world, const QueryShape& shape, Vec2d position, double angle,
                   const QueryFilter& filter, VisitShape visit);
template <class Real>
void overlap_shape(const BasicWorld<Real>& world, const QueryShape& shape, Vec2d position, double angle,
                   const QueryFilter& filter, std::vector<ShapeId>& found);
/// The same for a box along the axes; lower <= upper. The shapes themselves count, not their boxes.
template <class Real>
void overlap_box(const BasicWorld<Real>& world, const Aabb<double>& box, const QueryFilter& filter,
                 VisitShape visit);
template <class Real>
void overlap_box(const BasicWorld<Real>& world, const Aabb<double>& box, const QueryFilter& filter,
                 std::vector<ShapeId>& found);

/// Shapes that have `point` in them or on their surface.
template <class Real>
void shapes_at(const BasicWorld<Real>& world, Vec2d point, const QueryFilter& filter, VisitShape visit);
template <class Real>
void shapes_at(const BasicWorld<Real>& world, Vec2d point, const QueryFilter& filter,
               std::vector<ShapeId>& found);

/// The shape whose surface is nearest to `point`, of those not farther than `max_distance` (m, >= 0); inside
/// shapes the one it is deepest in. Of shapes at one distance that of the smaller index.
template <class Real>
std::optional<NearestResult> nearest(const BasicWorld<Real>& world, Vec2d point, double max_distance,
                                     const QueryFilter& filter = {});

/// Of any two shapes, sensors and shapes of one body included.
template <class Real>
ShapeDistance distance(const BasicWorld<Real>& world, ShapeId a, ShapeId b);

}  // namespace plumb
