#pragma once

#include <vector>

#include "engine/scene/scene.h"

namespace plumb::harness::hunt {

/// The points no farther than `radius` from a convex core: a point, a line or a polygon. Written for judging,
/// apart from the engine's own geometry.
struct Outline {
  std::vector<Vec2d> core{};  ///< m, counter-clockwise
  double radius = 0;          ///< m
  Vec2d low{}, high{};        ///< m, of a box that holds it
};

/// A shape as outlines in its body's frame: one, or of a chain one a segment.
std::vector<Outline> outlines_of(const Shape& shape);

/// `outline` of a body at `state`.
Outline placed(const Outline& outline, const BodyState& state);

/// The distance of two outlines, m; negative: the shortest way that parts them. Separating axes where their
/// cores meet (Gottschalk, Lin, Manocha 1996), the nearest of corners and edges elsewhere.
double separation(const Outline& a, const Outline& b);

/// The smallest width of the outline over all directions, and the largest distance of a point from the
/// body's centre, m.
double width_of(const Outline& outline);
double reach_of(const Outline& outline);

}  // namespace plumb::harness::hunt
