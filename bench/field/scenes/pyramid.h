#pragma once

#include "bench/field/scene.h"

namespace plumb::field {

/// Adds a pyramid of squares that stand edge to edge, `base` in the lowest row; returns its top. `left` is
/// the left edge of the lowest row, `ground` the height below it, `half` half a square's side, m.
Top add_pyramid(Builder& world, int base, double half, double left, double ground);

/// Builds one pyramid on a box 200 m wide with its upper side at height 0.
Built pyramid_on_ground(Builder& world, int base);

}  // namespace plumb::field
