#pragma once

#include <cmath>
#include <optional>

#include "engine/forces/outline.h"

namespace plumb {

/// A sudden pressure that spreads from a point.
struct Blast {
  Vec2d centre{};     ///< m
  double radius = 5;  ///< m, > 0: range
  double impulse =
      100;  ///< N s for each metre of surface square to it, at the centre; falls linearly to 0 at `radius`
};

/// Calls `visit(normal, length)` for 2^levels equal parts of an arc of unit normals from `from` to `to`, less
/// than half a turn: with the normal at the middle and the chord's length, so that the parts together are as
/// wide as the arc.
template <class Visit>
void visit_halves(Vec2d from, Vec2d to, int levels, Visit&& visit) {
  const Vec2d sum = from + to, middle = (1 / std::sqrt(length_squared(sum))) * sum;
  if (levels == 0) return visit(middle, std::sqrt(length_squared(to - from)));
  visit_halves(from, middle, levels - 1, visit), visit_halves(middle, to, levels - 1, visit);
}

/// Returns the part of a circle that faces the origin, or nothing if the origin is inside.
inline std::optional<OutlineArc> facing_circle(Vec2d centre, double radius) {
  const double distance = std::sqrt(length_squared(centre));
  if (distance <= radius) return std::nullopt;
  // The rays that touch the circle end where the normal has this cosine with the direction to the origin.
  const Vec2d towards = (-1 / distance) * centre;
  const double cosine = radius / distance, sine = std::sqrt(1 - cosine * cosine);
  const Vec2d across = sine * perpendicular(towards);
  return OutlineArc{centre, radius, cosine * towards - across, cosine * towards + across};
}

/// Returns the part of an arc that faces the origin, or nothing.
inline std::optional<OutlineArc> facing_arc(const OutlineArc& arc) {
  std::optional<OutlineArc> part = facing_circle(arc.centre, arc.radius);
  if (!part) return part;
  // Both are at most half a turn: they have at most one part in common, which starts and ends where one does.
  const auto has = [](const OutlineArc& of, Vec2d normal) {
    return cross(of.from, normal) >= 0 && cross(normal, of.to) >= 0;
  };
  const bool from = has(*part, arc.from), to = has(*part, arc.to);
  if ((!from && !has(arc, part->from)) || (!to && !has(arc, part->to))) return std::nullopt;
  if (from) part->from = arc.from;
  if (to) part->to = arc.to;
  return part;
}

/// Calls `push(impulse, point)` (N s, m) for the parts of a shape's outline that face the blast's centre. A
/// surface at distance d gets impulse (1 - d / radius) along the ray per metre across it; edges and the
/// facing parts of roundings are divided into eight pieces, each pushed at its middle. `shape` is relative to
/// the centre of the blast.
template <class Push>
void visit_blast(const Blast& blast, const Convex<double>& shape, Push&& push) {
  constexpr int kLevels = 3, kPieces = 1 << kLevels;
  const auto press = [&](Vec2d point, Vec2d normal, double length) {
    const double facing = -dot(point, normal), distance = std::sqrt(length_squared(point));
    if (facing <= 0 || distance >= blast.radius) return;
    // The width across the ray is length (facing / distance); the direction is point / distance.
    const double strength = blast.impulse * (1 - distance / blast.radius);
    push((strength * length * facing / (distance * distance)) * point, point);
  };
  const auto press_arc = [&](const std::optional<OutlineArc>& part) {
    if (!part) return;
    visit_halves(part->from, part->to, kLevels, [&](Vec2d normal, double length) {
      press(part->centre + part->radius * normal, normal, part->radius * length);
    });
  };
  // Discs are not divided where their outline is, so that they are pushed along the ray to their centre.
  if (shape.count == 1) return press_arc(facing_circle(shape.corners[0].point, shape.radius));
  visit_outline(
      shape,
      [&](Vec2d start, Vec2d end, Vec2d normal) {
        const double length = std::sqrt(length_squared(end - start)) / kPieces;
        for (int i = 0; i < kPieces; ++i)
          press(start + ((i + 0.5) / kPieces) * (end - start), normal, length);
      },
      [&](const OutlineArc& arc) { press_arc(facing_arc(arc)); });
}

}  // namespace plumb
