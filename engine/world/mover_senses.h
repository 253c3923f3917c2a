#pragma once

#include <optional>
#include <vector>

#include "engine/world/mover.h"
#include "engine/world/queries.h"

namespace plumb {

/// What a mover meets.
struct MoverContact {
  ShapeId shape{};
  BodyId body{};
  Vec2d point{}, normal{};  ///< m, unit, outward from the shape
  double gap = 0;           ///< m, negative: overlap
};

/// How far it got on a way, and what stopped it.
struct MoverWay {
  Vec2d position{};
  double travelled = 0;  ///< m
  std::optional<MoverContact> stop{};
};

/// What it stands on.
struct MoverGround {
  MoverContact contact{};
  Vec2d floor{};      ///< unit; the normal to walk along: of the tread at the edge of a step
  bool edge = false;  ///< of a step
};

/// A mover's knowledge of the world around it: everything that it does is built from these.
template <class Real>
class MoverSenses {
 public:
  MoverSenses(const BasicWorld<Real>& world, const Capsule& capsule, const MoverOptions& options);

  Vec2d up() const { return up_; }
  Vec2d right() const { return -perpendicular(up_); }
  double skin() const { return skin_; }
  double step_height() const { return step_height_; }
  double radius() const { return radius_; }
  bool is_walkable(Vec2d normal) const { return dot(normal, up_) >= walkable_; }

  /// Goes from `from` by `way`, and stops a skin before what it meets; shapes that it overlaps already, and
  /// the body `except`, do not stop it.
  MoverWay go(Vec2d from, Vec2d way, BodyId except = {}) const { return go(with_skin_, from, way, except); }
  /// The same, but stops only a quarter of a skin before what it meets: to get out of overlaps.
  MoverWay squeeze(Vec2d from, Vec2d way) const { return go(with_quarter_, from, way, {}); }
  /// Goes down until it stands on ground, by `most` m at most; none when it would not stand there.
  std::optional<MoverGround> find_ground(Vec2d& position, double most) const;
  /// Whether a contact of a mover at `position` is ground: flat enough, or the edge of a step.
  std::optional<MoverGround> ground_at(Vec2d position, const MoverContact& contact) const;
  /// The contact with the smallest gap, if that is below three quarters of the skin. A mover that goes away
  /// from a chain with `velocity` passes through it.
  std::optional<MoverContact> deepest(Vec2d position, Vec2d velocity) const;
  /// Whether a point is no higher than a step above the ground that a mover at `position` stands on.
  bool is_within_step(Vec2d point, Vec2d position) const {
    // It stands a skin above the ground; a tenth of that is for rounding.
    return dot(point - position, up_) - lowest_ <= step_height_ - 0.9 * skin_;
  }

 private:
  MoverWay go(const QueryShape& shape, Vec2d from, Vec2d way, BodyId except) const;
  std::optional<MoverContact> contact_with(ShapeId shape, Vec2d position, Vec2d velocity) const;

  const BasicWorld<Real>& world_;
  QueryShape capsule_, with_skin_, with_quarter_;
  QueryFilter filter_;
  Vec2d up_;
  double radius_, skin_, step_height_, walkable_, lowest_;
};

}  // namespace plumb
