#pragma once

#include "engine/math/lane_rows.h"
#include "engine/math/lanes.h"

namespace plumb {

/// Four numbers, in registers of 16 bytes that all processors have.
template <class Real>
using Four = Lanes<Real, 4>;

}  // namespace plumb
