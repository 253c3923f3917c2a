#pragma once

#include "engine/world/world_data.h"

namespace plumb {

/// Closes joints that a step of `substeps` substeps, of h (s) each, has left open. If a step has opened a
/// rigid row, or a limit along an axis, by more than kMaxGap, the bodies of its mechanism (all that joints
/// connect to it) are moved. Each round is a Gauss-Newton step in the metric of the masses, which keeps
/// momentum. Limits and contacts take part in it by complementarity, so no body is pressed into another.
/// Afterwards the part of the velocities that opens joints is removed. Mechanisms with many loops are left as
/// they are. Reasons: docs/decisions/jointed-islands.md.
template <class Real>
void close_joint_gaps(WorldData<Real>& w, double h, int substeps);

}  // namespace plumb
