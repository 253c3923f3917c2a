#pragma once

#include <array>
#include <cstddef>

#include "engine/world/world_data.h"

namespace plumb {

/// Prefetches the contacts of the next 8 swept bodies, one of each at a time, because contact
/// records are scattered in memory.
class PrefetchContacts {
 public:
  PrefetchContacts() { edges_.fill(kNone); }

  template <class Real>
  void advance(const WorldData<Real>& w, std::size_t index) {
    const auto prefetch = [&](int edge) {
      if (edge != kNone) __builtin_prefetch(&w.contacts[edge / 2]);
      return edge;
    };
    for (int& edge : edges_)
      if (edge != kNone) edge = prefetch(w.contacts[edge / 2].next[edge & 1]);
    const std::size_t ahead = index + edges_.size();
    if (ahead < w.scratch.continuous.swept_bodies.size())
      edges_[index % edges_.size()] =
          prefetch(w.bodies[w.scratch.continuous.swept_bodies[ahead].body].first_contact);
  }

 private:
  std::array<int, 8> edges_;
};

}  // namespace plumb
