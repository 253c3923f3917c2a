#pragma once

#include "engine/world/world_data.h"

/// Contacts as the solution has left them. Only for continuous.cpp.
namespace plumb {

/// Marks the bodies with a loaded contact in this step, and those that a contact may support.
template <class Real>
void find_loaded_bodies(WorldData<Real>& w);

/// Collects contacts almost as deep as a core, which are checked even if their depth grows slowly.
template <class Real>
void find_deep_contacts(WorldData<Real>& w);

}  // namespace plumb
