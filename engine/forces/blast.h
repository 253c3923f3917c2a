#pragma once

#include <cmath>

#include "engine/forces/outline.h"

namespace plumb {

/// A sudden pressure that spreads from a point.
struct Blast {
  Vec2d centre{};     ///< m
  double radius = 5;  ///< m, > 0: range
  double impulse =
      100;  ///< N s for each metre of surface square to it, at the centre; falls linearly to 0 at `radius`
};

/// Calls `push(impulse, point)` (N s, m) for the parts of a shape's outline that face the blast's centre. A
/// surface at distance d gets impulse (1 - d / radius) along the ray per metre across it; straight edges are
/// divided into pieces. `shape` is relative to the centre of the blast.
template <class Push>
void visit_blast(const Blast& blast, const Convex<double>& shape, Push&& push) {
  constexpr int kPieces = 8;  // per edge
  const auto strength = [&](double distance) {
    return distance < blast.radius ? blast.impulse * (1 - distance / blast.radius) : 0.0;
  };
  visit_outline(
      shape,
      [&](Vec2d start, Vec2d end, Vec2d normal) {
        const double length = std::sqrt(length_squared(end - start)) / kPieces;
        for (int i = 0; i < kPieces; ++i) {
          const Vec2d point = start + ((i + 0.5) / kPieces) * (end - start);
          const double facing = -dot(point, normal), distance = std::sqrt(length_squared(point));
          if (facing <= 0 || distance >= blast.radius) continue;
          // The width across the ray is length (facing / distance); the direction is point / distance.
          push((strength(distance) * length * facing / (distance * distance)) * point, point);
        }
      },
      [&](const OutlineArc& arc) {
        const double to_centre = std::sqrt(length_squared(arc.centre));
        if (to_centre <= arc.radius) return;
        const Vec2d outward = (1 / to_centre) * arc.centre;
        const FacingArc part = facing_part(arc, -outward);
        const double across = arc.radius * (part.sine_to - part.sine_from);
        const double distance = to_centre - arc.radius;
        if (across <= 0 || distance >= blast.radius) return;
        push((strength(distance) * across) * outward, arc.centre - arc.radius * outward);
      });
}

}  // namespace plumb
