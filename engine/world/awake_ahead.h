#pragma once

#include <cstddef>

#include "engine/world/world_data.h"

namespace plumb {

/// A pass over the awake bodies reads a dozen lists. A million bodies fit into no cache, and a processor
/// follows a list by itself to the end of a page alone: what the pass is going to read is asked for some
/// bodies ahead.
template <class Real>
class AwakeAhead {
 public:
  explicit AwakeAhead(const WorldData<Real>& w)
      : w_(w), end_(w.awake.size() > kCached ? w.awake.size() : 0) {}

  // GCC 12 drops calls of a function that does nothing else, unless they are expanded first.
  [[gnu::always_inline]] void ask_for_motion(std::size_t place) const {
    if (place + kBodies >= end_) return;
    const int body = w_.awake[place + kBodies];
    __builtin_prefetch(&w_.bodies[body]), __builtin_prefetch(&w_.motion[body]);
  }
  /// Of a body whose motion was asked for.
  [[gnu::always_inline]] void ask_for_place(std::size_t place) const {
    if (place + kShapes >= end_) return;
    const int body = w_.awake[place + kShapes], shape = w_.bodies[body].first_shape;
    __builtin_prefetch(&w_.position[body]), __builtin_prefetch(&w_.rotation[body]);
    if (shape == kNone) return;
    __builtin_prefetch(&w_.shapes[shape]), __builtin_prefetch(&w_.forms[shape]);
    __builtin_prefetch(&w_.boxes[shape]);
  }

 private:
  /// Fewer bodies are in a cache as it is: asking would only take time.
  static constexpr std::size_t kCached = 1 << 14;
  static constexpr std::size_t kBodies = 32, kShapes = 16;

  const WorldData<Real>& w_;
  std::size_t end_;
};

}  // namespace plumb
