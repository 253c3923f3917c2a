#pragma once

#include <cmath>

#include "engine/math/vec2.h"

namespace plumb::harness {

/// Returns the length of a vector. Bounds of chaotic motions grow beyond the square root of the largest
/// double: unlike `length`, this does not overflow in between.
inline double magnitude(Vec2d v) { return std::hypot(v.x, v.y); }

}  // namespace plumb::harness
