#pragma once

#include <vector>

#include "engine/core/block_lists.h"
#include "engine/world/state/swept_body.h"

namespace plumb {

/// A body whose motion in a step is tested for impacts, because it moved far for its size, or because a
/// bounce is `expected`. `covered`: its fat AABBs contained the whole motion, so only its contacts need
/// testing.
struct FastBody {
  int body = 0;
  bool covered = false;
  bool expected = false;
};

/// Data of continuous collision within a step.
template <class Real>
struct ContinuousScratch {
  BlockLists<FastBody> found_fast;
  std::vector<FastBody> fast_bodies;
  std::vector<int> deep_contacts;  ///< contacts with a penetration near the cores
  std::vector<SweptBody> swept_bodies;
  std::vector<int> stopped;          ///< swept bodies that are being stopped together
  std::vector<ToiEvent> toi_events;  ///< a heap, earliest on top
  BlockLists<int> found_deep;
  BlockLists<ToiEvent> found_toi_events;
  std::vector<int> swept_index_of;  ///< by body: index of its swept body, during continuous collision
};

}  // namespace plumb
