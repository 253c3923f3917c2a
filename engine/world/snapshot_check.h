#pragma once

#include "engine/world/world_data.h"

namespace plumb {

/// Checks that data read from a snapshot are consistent: sizes, links, indices, numbers. Throws Error (Value,
/// subject "snapshot") otherwise: no bytes, however damaged, may make a step read beyond an array.
template <class Real>
void check_state(const WorldData<Real>& w);

}  // namespace plumb
