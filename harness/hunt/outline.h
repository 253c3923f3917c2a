#pragma once

#include <vector>

#include "engine/scene/scene.h"

namespace plumb::harness::hunt {

/// The points no farther than `radius` from a convex core: a point, a line or a polygon. Written for judging,
/// independent of the engine's own geometry.
struct Outline {
  std::vector<Vec2d> core{};  ///< m, counter-clockwise
  double radius = 0;          ///< m
  Vec2d low{}, high{};        ///< m, its bounding box
};

/// Returns a shape as outlines in its body's frame: one, or for a chain one per segment.
std::vector<Outline> outlines_of(const Shape& shape);

/// Transforms `outline` of a body to the world at `state`.
Outline placed(const Outline& outline, const BodyState& state);

/// Returns the distance of two outlines, m; negative: the shortest displacement that separates them.
/// Separating axes if their cores overlap (Gottschalk, Lin, Manocha 1996), else the nearest corners and
/// edges.
double separation(const Outline& a, const Outline& b);

/// Returns the smallest width of the outline over all directions, and the largest distance of a point from
/// the body's centre, m.
double width_of(const Outline& outline);
double reach_of(const Outline& outline);

/// Area of an outline, m^2, its centroid, m, and its second moment about that, m^4.
struct AreaMoments {
  double area = 0, second = 0;
  Vec2d centroid{};
};

/// Returns the moments by Green's theorem; round outlines as a polygon, with an error of 1e-4.
AreaMoments moments_of(const Outline& outline);

}  // namespace plumb::harness::hunt
