#pragma once

#include <cmath>

#include "engine/math/vec2.h"

/// Says which normals at an end of a chain segment belong to it, for contacts and for continuous collision.
namespace plumb {

/// Bends below this, in rad, are ignored: a curve of short segments is as smooth as a line.
inline constexpr double kFlatBend = 0.01;

/// The chain's continuation at one end of a segment.
template <class Real>
struct ChainNeighbour {
  bool open;            ///< no neighbour: the end is a corner
  bool convex;          ///< it bends away from the front
  bool hollow;          ///< it bends towards the front
  Vec2<Real> normal{};  ///< the neighbour's
};

/// Returns the continuation at an end of a segment with the given normal. `corner` is the shared vertex and
/// `other` the neighbour's far one; `first`: at the segment's first end.
template <class Real>
ChainNeighbour<Real> chain_neighbour(Vec2<Real> corner, Vec2<Real> other, Vec2<Real> normal, bool first) {
  const Vec2<Real> edge = first ? corner - other : other - corner;
  const Real length = std::sqrt(length_squared(edge));
  if (!(length > 0)) return {true, true, false};
  const Vec2<Real> own{edge.y / length, -edge.x / length};
  const Real bend = first ? cross(own, normal) : cross(normal, own);
  return {false, bend > Real(kFlatBend), bend < -Real(kFlatBend), own};
}

/// Returns true if a normal out of the segment, beyond its own at the given end, is not beyond that of a
/// neighbour which bends away from the front.
template <class Real>
bool is_within_bend(const ChainNeighbour<Real>& end, Vec2<Real> normal, bool first) {
  const Real inside = first ? cross(end.normal, normal) : cross(normal, end.normal);
  return inside >= -Real(kFlatBend);
}

}  // namespace plumb
