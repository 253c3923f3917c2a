#pragma once

#include "engine/world/world_data.h"

namespace plumb {

/// Whether what was read from a snapshot fits together: sizes, links, places, numbers. Throws Error (Value,
/// subject "snapshot") where it does not: no step may read beyond an array, whatever the bytes were.
template <class Real>
void check_state(const WorldData<Real>& w);

}  // namespace plumb
