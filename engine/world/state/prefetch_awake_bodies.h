#pragma once

#include <cstddef>

#include "engine/world/world_data.h"

namespace plumb {

/// Software prefetch for loops over the awake bodies, which read a dozen arrays. A million bodies fit into no
/// cache, and hardware prefetchers stop at page boundaries. So this prefetches some bodies ahead.
template <class Real>
class PrefetchAwakeBodies {
 public:
  explicit PrefetchAwakeBodies(const WorldData<Real>& w)
      : w_(w), end_(w.awake.size() > kCached ? w.awake.size() : 0) {}

  // GCC 12 removes calls of a function that only prefetches, unless they are inlined first.
  [[gnu::always_inline]] void prefetch_motion(std::size_t index) const {
    if (index + kBodies >= end_) return;
    const int body = w_.awake[index + kBodies];
    __builtin_prefetch(&w_.bodies[body]), __builtin_prefetch(&w_.motion[body]);
  }
  /// Prefetches pose and first shape of a body whose motion was prefetched before.
  [[gnu::always_inline]] void prefetch_pose(std::size_t index) const {
    if (index + kShapes >= end_) return;
    const int body = w_.awake[index + kShapes], shape = w_.bodies[body].first_shape;
    __builtin_prefetch(&w_.position[body]), __builtin_prefetch(&w_.rotation[body]);
    if (shape == kNone) return;
    __builtin_prefetch(&w_.shapes[shape]), __builtin_prefetch(&w_.forms[shape]);
    __builtin_prefetch(&w_.tight_aabbs[shape]);
  }

 private:
  /// If there are fewer bodies than this, they fit into a cache and prefetching only costs time.
  static constexpr std::size_t kCached = 1 << 14;
  static constexpr std::size_t kBodies = 32, kShapes = 16;

  const WorldData<Real>& w_;
  std::size_t end_;
};

}  // namespace plumb
