#pragma once

#include "engine/world/world_data.h"

namespace plumb {

/// Closes joints that iterations have left open, after the motion of a step's last substep: where rigid rows
/// or limits of a joint are open by more than tuning::kOpening, the bodies of its mechanism (all that joints
/// tie to it) are moved until none is. Each round is a Gauss-Newton step in the metric of the masses, so that
/// momentum is kept and velocities do not change. Joints in `apart` (by slot; may be empty) are left alone.
/// Reasons: docs/decisions/jointed-islands.md.
template <class Real>
void close_joint_gaps(WorldData<Real>& w, const std::vector<char>& apart);

}  // namespace plumb
