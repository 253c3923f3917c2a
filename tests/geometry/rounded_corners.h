#pragma once

#include <span>
#include <vector>

#include "engine/geometry/convex_hull.h"

namespace plumb {

/// Rounds corners to the precision of a world.
template <class Real>
std::vector<Corner<Real>> rounded_to(std::span<const Corner<double>> corners) {
  std::vector<Corner<Real>> out;
  for (const Corner<double>& corner : corners)
    out.push_back({corner.point.as<Real>(), corner.normal.as<Real>()});
  return out;
}

}  // namespace plumb
