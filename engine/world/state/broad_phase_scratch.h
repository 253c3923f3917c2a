#pragma once

#include <utility>
#include <vector>

#include "engine/core/block_lists.h"
#include "engine/geometry/aabb.h"

namespace plumb {

/// A shape that has left its fat AABB, with its next fat AABB.
template <class Real>
struct ProxyUpdate {
  int shape = 0;
  Aabb<Real> box{};
};

/// Data of the search for pairs within a step.
template <class Real>
struct BroadPhaseScratch {
  std::vector<std::pair<int, int>> found_pairs;
  BlockLists<std::pair<int, int>> found_pairs_of;  ///< by block of moved shapes
  std::vector<char> has_overlap;                   ///< by proxy of the dynamic tree
  BlockLists<ProxyUpdate<Real>> proxy_updates;     ///< by block of awake bodies
};

}  // namespace plumb
