#pragma once

#include "engine/solve/soft_contacts.h"
#include "engine/world/world_data.h"

/// Small islands of contacts are solved directly, besides the sweeps: towers, heavy loads on light things
/// hold as well as a single contact does. Islands with joints are chosen here as well;
/// engine/world/jointed_islands.h solves them. What is too large for that has the sweeps alone.
namespace plumb {

/// Finds them and factorises their systems, at the start of a step. Joints have been prepared.
template <class Real>
void prepare_direct_islands(WorldData<Real>& w);

/// Impulses such that all of an island's rows hold: with the push out of overlaps before bodies move
/// (`push`), without it afterwards.
template <class Real>
void solve_direct_islands(WorldData<Real>& w, const ContactStep<Real>& step, bool push);

/// Contacts answer softly again.
template <class Real>
void finish_direct_islands(WorldData<Real>& w);

}  // namespace plumb
