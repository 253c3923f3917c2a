#pragma once

#include <vector>

#include "engine/world/query_filter.h"
#include "engine/world/world.h"

/// A character that a game moves itself: a capsule that is not a body of the world, but is stopped by them.
namespace plumb {

struct MoverOptions {
  Vec2d up{0, 1};            ///< any length but 0
  double max_slope = 0.8;    ///< rad, 0 .. pi/2: the steepest ground that it stands and walks on
  double step_height = 0.3;  ///< m, >= 0: highest step that it climbs, and that it walks down without falling
  double skin = 0;           ///< m, the gap that it keeps; 0: a fiftieth of the radius
  double mass = 0;           ///< kg, with which it pushes dynamic bodies; 0: it does not
  double push_force = 1e12;  ///< N, >= 0: most that it pushes one body with
  QueryFilter filter{};      ///< what stops it; sensors never do
};

/// A surface that it ran into or stands on.
struct MoverHit {
  ShapeId shape{};
  BodyId body{};
  Vec2d point{};       ///< m, on the surface
  Vec2d normal{};      ///< unit, outward from the shape
  double impulse = 0;  ///< N s, >= 0, against the normal, for a dynamic body to take
};

struct MoverResult {
  Vec2d position{};  ///< m
  Vec2d velocity{};  ///< m/s; see move()
  bool on_ground = false;
  bool squeezed = false;    ///< it overlaps bodies and found no way out
  Vec2d ground_normal{};    ///< unit; of the tread where it stands on the edge of a step
  BodyId ground{};          ///< what it stands on
  Vec2d ground_velocity{};  ///< m/s, of the ground where it stands, with its surface speed
  std::vector<MoverHit> hits{};
};

/// Moves a capsule, which stands in the frame of `position` and never turns, by `velocity` for `dt` s. To be
/// called before the world's step of the same dt: it is carried by the ground's motion in that step.
///
/// It is first pushed out of what it overlaps. In the air it moves by its velocity, and slides along what it
/// meets. On the ground the component of its velocity across `up` is its speed along the ground, uphill and
/// downhill; the component against `up` presses it down, the component along `up`, if there is one, lets it
/// jump. All motion is by shape casts: at no speed does it get through anything, and it never comes nearer
/// than the skin to what does not move towards it, but for roundings.
///
/// `velocity` is relative to the ground while it stands, and to the world in the air, before and after: who
/// lands on or leaves a moving platform loses or gains the platform's velocity. Gravity is the caller's to
/// add. Throws Error (Value) for numbers out of their range.
template <class Real>
MoverResult move(const BasicWorld<Real>& world, const Capsule& capsule, Vec2d position, Vec2d velocity,
                 double dt, const MoverOptions& options = {});

/// Gives dynamic bodies the impulses of what ran into them.
template <class Real>
void apply_pushes(BasicWorld<Real>& world, const MoverResult& result);

}  // namespace plumb
