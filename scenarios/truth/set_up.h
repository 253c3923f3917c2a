#pragma once

#include <cmath>

#include "engine/math/arc_tangent.h"
#include "engine/math/trigonometry.h"
#include "engine/math/vec2.h"

/// Trigonometry for the numbers of a scene. In double and without libm, so that a scene has the same bits on
/// every platform: libm's last bits differ, and so does the precision of `Real`. Truths use libm and `Real`.
namespace plumb::scenarios::truth::set_up {

/// Returns (cos, sin) of `angle`, in rad.
inline Vec2d direction(double angle) {
  const Rotation<double> turn = rotation_of(angle);
  return {turn.c, turn.s};
}

/// Rotates `v` by `angle`, in rad.
inline Vec2d turned(double angle, Vec2d v) { return rotation_of(angle) * v; }

inline double tangent(double angle) {
  const Vec2d way = direction(angle);
  return way.y / way.x;
}

/// Returns the angle in rad whose sine is `x`, from -1 to 1.
inline double arc_sine(double x) { return arc_tangent(x, std::sqrt((1 - x) * (1 + x))); }

}  // namespace plumb::scenarios::truth::set_up
