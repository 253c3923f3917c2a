#pragma once

#include "engine/math/vec2.h"

namespace plumb {

/// An axis-aligned bounding box, m.
template <class Real>
struct Aabb {
  Vec2<Real> lower{}, upper{};

  bool contains(const Aabb& other) const {
    return lower.x <= other.lower.x && lower.y <= other.lower.y && upper.x >= other.upper.x &&
           upper.y >= other.upper.y;
  }
  bool overlaps(const Aabb& other) const {
    return lower.x <= other.upper.x && lower.y <= other.upper.y && upper.x >= other.lower.x &&
           upper.y >= other.lower.y;
  }
  Aabb grown(Real margin) const {
    return {{lower.x - margin, lower.y - margin}, {upper.x + margin, upper.y + margin}};
  }
  /// Returns half the perimeter, which is proportional to the probability of a hit (surface-area heuristic in
  /// the plane).
  Real half_perimeter() const { return (upper.x - lower.x) + (upper.y - lower.y); }
};

/// Returns the smallest box around both.
template <class Real>
Aabb<Real> merged(const Aabb<Real>& a, const Aabb<Real>& b) {
  const auto least = [](Real x, Real y) { return y < x ? y : x; };
  const auto most = [](Real x, Real y) { return x < y ? y : x; };
  return {{least(a.lower.x, b.lower.x), least(a.lower.y, b.lower.y)},
          {most(a.upper.x, b.upper.x), most(a.upper.y, b.upper.y)}};
}

}  // namespace plumb
