#pragma once

#include <vector>

#include "engine/world/queries/query_filter.h"
#include "engine/world/world.h"

/// Character controller: a capsule that is not a body of the world, but is stopped by its bodies.
namespace plumb {

struct MoverOptions {
  Vec2d up{0, 1};            ///< up direction, of any length but 0
  double max_slope = 0.8;    ///< rad, 0 .. pi/2: steepest ground to stand and walk on
  double step_height = 0.3;  ///< m, >= 0: highest step to climb, and to walk down without falling
  double skin = 0;           ///< m, gap kept to surfaces; 0: a fiftieth of the radius
  double mass = 0;           ///< kg, mass for pushing dynamic bodies; 0: no pushes
  double push_force = 1e12;  ///< N, >= 0: largest force on one body
  QueryFilter filter{};      ///< shapes that stop it; sensors never stop it
};

/// A surface that the mover hit or stands on.
struct MoverHit {
  ShapeId shape{};
  BodyId body{};
  Vec2d point{};       ///< m, on the surface
  Vec2d normal{};      ///< unit, outward from the shape
  double impulse = 0;  ///< N s, >= 0, to be applied to a dynamic body, against the normal
};

struct MoverResult {
  Vec2d position{};  ///< m
  Vec2d velocity{};  ///< m/s; see move()
  bool on_ground = false;
  bool squeezed = false;    ///< it could not be pushed out of an overlap
  Vec2d ground_normal{};    ///< unit; that of the tread on the edge of a step
  BodyId ground{};          ///< body that it stands on
  Vec2d ground_velocity{};  ///< m/s, of the ground at the contact point, with its surface speed
  std::vector<MoverHit> hits{};
};

/// Moves a capsule, given in the frame of `position` and never rotated, by `velocity` for `dt` s. Call it
/// before the world's step of the same dt, because the ground carries the capsule through that step.
/// First it is pushed out of overlaps. In the air it moves with its velocity, and slides along obstacles. On
/// the ground, the velocity component across `up` is the speed along the ground, uphill and downhill. A
/// component against `up` presses on the ground, and one along `up` makes it jump. All motion uses shape
/// casts, so it does not tunnel at any speed. Up to rounding, it keeps a gap of the skin to everything that
/// does not move towards it.
/// `velocity` is relative to the ground while the mover stands, and to the world while it is in the air; this
/// holds before and after the call. So landing on a moving platform subtracts the platform's velocity, and
/// leaving it adds that velocity. The caller adds gravity. Throws Error (Value) for numbers out of their
/// range.
template <class Real>
MoverResult move(const BasicWorld<Real>& world, const Capsule& capsule, Vec2d position, Vec2d velocity,
                 double dt, const MoverOptions& options = {});

/// Applies the impulses of the mover's hits to dynamic bodies.
template <class Real>
void apply_pushes(BasicWorld<Real>& world, const MoverResult& result);

}  // namespace plumb
