#pragma once

#include <cmath>

#include "engine/math/vec2.h"

namespace plumb::harness {

/// Returns the length of a vector. Unlike `length` this does not overflow in between: bounds of chaotic
/// motions may exceed the square root of the largest double.
inline double magnitude(Vec2d v) { return std::hypot(v.x, v.y); }

}  // namespace plumb::harness
