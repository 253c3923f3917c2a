#pragma once

#include "engine/world/world_data.h"

namespace plumb {

/// Lets contacts yield to joints that are open. An impact may open a joint for a moment, and another body may
/// come in between, or be caught behind. The joint then pulls without end, and contacts that carry a load
/// without deflection hold against it: a heap of ragdolls would stay dislocated. Contacts of the joint's
/// bodies therefore forget their load estimates, and those with a dynamic body that lies between the ends of
/// the joint are disabled in this step (`WorldData::disabled_pairs`).
template <class Real>
void yield_to_open_joints(WorldData<Real>& w);

}  // namespace plumb
