#pragma once

#include "engine/math/vec2.h"

namespace plumb::harness {

/// A circle or a box at its present pose. Written for measuring only: sharing the engine's geometry would
/// hide its mistakes.
struct PlacedShape {
  bool is_circle = true;
  Vec2d centre{};          ///< m
  Vec2d axis{1, 0};        ///< unit, along the box's width
  double half_width = 0;   ///< m; of a circle its radius
  double half_height = 0;  ///< m; of a circle its radius
};

/// Returns half the extent of `shape` along the unit vector `direction`, m.
double half_extent(const PlacedShape& shape, Vec2d direction);

/// Returns the depth of penetration of two shapes, m: the shortest displacement that separates them; negative
/// or zero if they do not touch. Box against box by separating axes (Gottschalk, Lin, Manocha 1996).
double overlap(const PlacedShape& a, const PlacedShape& b);

}  // namespace plumb::harness
