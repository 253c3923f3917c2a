#pragma once

#include "engine/world/world_data.h"

/// How the gaps of joints in direct islands close. Velocities close them as those of all joints (a pull in
/// the solution before bodies move, taken out after it), which keeps energy. A chain that snaps taut cannot
/// be pulled so: where it is almost straight, only wide turns of its links would close a gap, and those do
/// not come out of velocities again. Then bodies are moved instead.
namespace plumb {

/// Sets the rows' pulls for the gaps at the poses of the last factorisation.
template <class Real>
void pull_gaps(WorldData<Real>& w, DirectIsland<Real>& island, const JointStep<Real>& step);

/// After the motion, with the rows factorised where bodies are: moves bodies where `pull_gaps` did not pull.
/// `h` is the substep, s.
template <class Real>
void close_gaps(WorldData<Real>& w, DirectIsland<Real>& island, Real h);

}  // namespace plumb
