#pragma once

#include "engine/world/world_data.h"

namespace plumb {

/// Lists the bounces of a step: contacts with restitution, and discs that approach each other fast, whose
/// normal is followed to where they meet.
template <class Real>
void find_bounces(WorldData<Real>& w);

}  // namespace plumb
