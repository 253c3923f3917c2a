#pragma once

#include <algorithm>

#include "engine/math/vec2.h"

namespace plumb {

/// A box along the axes, m.
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
  /// Half the perimeter: how likely a query hits it (the surface-area heuristic in the plane).
  Real half_perimeter() const { return (upper.x - lower.x) + (upper.y - lower.y); }
};

/// The smallest box around both.
template <class Real>
Aabb<Real> merged(const Aabb<Real>& a, const Aabb<Real>& b) {
  return {{std::min(a.lower.x, b.lower.x), std::min(a.lower.y, b.lower.y)},
          {std::max(a.upper.x, b.upper.x), std::max(a.upper.y, b.upper.y)}};
}

}  // namespace plumb
