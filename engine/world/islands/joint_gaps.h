#pragma once

#include "engine/world/world_data.h"

namespace plumb {

/// Closes joints that a step of `substeps` substeps, of h (s) each, has left open. Where a rigid row, or a
/// limit along an axis, is open by more than kOpening, the bodies of its mechanism (all that joints
/// tie to it) are moved. Each round is a Gauss-Newton step in the metric of the masses, which keeps momentum;
/// limits and contacts take part in it by complementarity, so nothing is pressed into what it lies on. The
/// part of the velocities that opens joints is taken from them. Mechanisms with many loops are left as they
/// are. Reasons: docs/decisions/jointed-islands.md.
template <class Real>
void close_joint_gaps(WorldData<Real>& w, double h, int substeps);

}  // namespace plumb
