#pragma once

#include "engine/world/world_data.h"

namespace plumb {

/// Checks that data read from a snapshot are consistent: sizes, links, indices, numbers. Throws Error (Value,
/// subject "snapshot") if not, because no step may read beyond an array, whatever the bytes.
template <class Real>
void check_state(const WorldData<Real>& w);

}  // namespace plumb
