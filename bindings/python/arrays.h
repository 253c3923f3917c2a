#pragma once

#include "engine/world/world.h"

namespace plumb::python {

/// Writes x, y (m, of the origins) and angles (rad) of all bodies by index, three numbers a body; NaN for
/// those that were destroyed. A pass over the world's arrays, compiled for speed.
template <class Real>
void write_poses(const BasicWorld<Real>& world, double* to);

extern template void write_poses(const World&, double*);
extern template void write_poses(const DoubleWorld&, double*);

}  // namespace plumb::python
