#pragma once

#include "engine/solve/soft_contacts.h"
#include "engine/world/world_data.h"

/// Small islands are solved directly, besides the sweeps: contacts, or joints; with Solver::Direct all that
/// joints tie together: towers, heavy loads on light things, chains with a heavy tip hold as well as a single
/// contact does. What is too large for that has the sweeps alone.
namespace plumb {

/// Finds them and factorises their systems, at the start of a step.
template <class Real>
void prepare_direct_islands(WorldData<Real>& w, const JointStep<Real>& joints);

/// Impulses such that all of an island's rows hold: with the push out of overlaps before bodies move
/// (`push`), without it afterwards. Joints have been evaluated where the bodies are.
template <class Real>
void solve_direct_islands(WorldData<Real>& w, const ContactStep<Real>& step, const JointStep<Real>& joints,
                          bool push);

/// Solver::Direct, after bodies have moved: closes the joints of direct islands by Newton steps on positions.
/// Velocities are fitted to where bodies are then.
template <class Real>
void close_direct_joints(WorldData<Real>& w, const JointStep<Real>& joints);

/// Contacts answer softly again.
template <class Real>
void finish_direct_islands(WorldData<Real>& w);

}  // namespace plumb
