#pragma once

#include <optional>

#include "engine/world/mover.h"
#include "engine/world/queries.h"

namespace plumb {

/// Contact of a mover with a shape.
struct MoverContact {
  ShapeId shape{};
  BodyId body{};
  Vec2d point{}, normal{};  ///< m, unit, outward from the shape
  double gap = 0;           ///< m, negative: overlap
};

/// Result of a shape cast: the position reached, and the contact that stopped it.
struct MoverCast {
  Vec2d position{};
  double travelled = 0;  ///< m
  std::optional<MoverContact> hit{};
};

/// Ground below a mover.
struct MoverGround {
  MoverContact contact{};
  Vec2d floor{};      ///< unit; the normal to walk along: that of the tread at the edge of a step
  bool edge = false;  ///< edge of a step
};

/// Queries of a mover's surroundings. All its motion is built from them.
template <class Real>
class MoverQueries {
 public:
  MoverQueries(const BasicWorld<Real>& world, const Capsule& capsule, const MoverOptions& options);

  Vec2d up() const { return up_; }
  Vec2d right() const { return -perpendicular(up_); }
  double skin() const { return skin_; }
  double step_height() const { return step_height_; }
  bool is_walkable(Vec2d normal) const { return dot(normal, up_) >= max_slope_cosine_; }

  /// Moves from `from` by `displacement`, and stops a skin before an obstacle. Ignores the body `except` and
  /// shapes that the mover overlaps already.
  MoverCast cast(Vec2d from, Vec2d displacement, BodyId ignored = {}) const {
    return cast(with_skin_, from, displacement, ignored);
  }
  /// Does the same, but stops only a quarter of a skin before an obstacle. For leaving overlaps.
  MoverCast cast_quarter_skin(Vec2d from, Vec2d displacement) const {
    return cast(with_quarter_skin_, from, displacement, {});
  }
  /// Moves `position` down onto ground, by at most `max_drop` m. Returns nullopt and does not move if there
  /// is no ground to stand on. `base`: as for is_within_step.
  std::optional<MoverGround> find_ground(Vec2d& position, double max_drop, double base = 0) const;
  /// Returns the ground if a contact of a mover at `position` is flat enough, or the edge of a step.
  std::optional<MoverGround> ground_at(Vec2d position, const MoverContact& contact, double base = 0) const;
  /// Returns the contact with the smallest gap, if that is below three quarters of the skin. A mover that
  /// moves away from a chain with `velocity` passes through it.
  std::optional<MoverContact> deepest(Vec2d position, Vec2d velocity) const;
  /// Returns the height of the contact with an even floor over the mover's lowest point, less that on level
  /// ground, m.
  double contact_height(Vec2d floor) const { return (radius_ + skin_) * (1 - dot(floor, up_)); }
  /// Returns true if a point is no higher than a step above the ground that a mover at `position` stands on.
  /// That is `base` m above the mover's lowest point.
  bool is_within_step(Vec2d point, Vec2d position, double base = 0) const {
    // The mover stands a skin above the ground; a tenth of the skin allows for rounding.
    return dot(point - position, up_) - foot_height_ - base <= step_height_ - 0.9 * skin_;
  }

 private:
  MoverCast cast(const QueryShape& shape, Vec2d from, Vec2d displacement, BodyId ignored) const;
  std::optional<MoverContact> contact_with(ShapeId shape, Vec2d position, Vec2d velocity) const;

  const BasicWorld<Real>& world_;
  QueryShape capsule_, with_skin_, with_quarter_skin_;
  QueryFilter filter_;
  Vec2d up_;
  double radius_, skin_, step_height_, max_slope_cosine_, foot_height_;
};

}  // namespace plumb
