#pragma once

#include "engine/math/vec2.h"

namespace plumb::harness {

/// A circle or a box where it is now. Written for measuring, apart from the engine's own geometry, so that
/// one does not hide the other's mistakes.
struct PlacedShape {
  bool is_circle = true;
  Vec2d centre{};          ///< m
  Vec2d axis{1, 0};        ///< unit, along the box's width
  double half_width = 0;   ///< m; of a circle its radius
  double half_height = 0;  ///< m; of a circle its radius
};

/// Half the extent of `shape` along the unit vector `direction`, m.
double half_extent(const PlacedShape& shape, Vec2d direction);

/// How deep two shapes overlap, m: the shortest way that parts them; negative or zero when they do not touch.
/// Box against box by separating axes (Gottschalk, Lin, Manocha 1996).
double overlap(const PlacedShape& a, const PlacedShape& b);

}  // namespace plumb::harness
