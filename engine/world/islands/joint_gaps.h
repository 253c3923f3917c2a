#pragma once

#include "engine/world/world_data.h"

namespace plumb {

/// Closes joints that velocities have left open, after the motion of a step's last substep. Where a rigid row
/// or limit is open by more than tuning::kOpening, the bodies of its mechanism (all that joints tie to it)
/// are moved. Each round is a Gauss-Newton step in the metric of the masses: momentum is kept, and velocities
/// do not change. Mechanisms with many loops are left as they are. Reasons:
/// docs/decisions/jointed-islands.md.
template <class Real>
void close_joint_gaps(WorldData<Real>& w);

}  // namespace plumb
