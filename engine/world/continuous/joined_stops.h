#pragma once

#include <vector>

#include "engine/world/world_data.h"

/// Bodies that joints tie together and that continuous collision stops at the same time. For continuous.cpp
/// alone.
namespace plumb {

/// Takes from bodies that are stopped together at a fraction of the step the work of forces in the rest of
/// it: these do none on what does not move. Otherwise a mechanism that hangs on what stops it would fall
/// faster from step to step without falling. What contacts have given them stays, with its momentum.
template <class Real>
void take_unmoved_work(WorldData<Real>& w, const std::vector<int>& places, double fraction, double dt);

/// Sets how far bodies that are to be stopped together have to move for their joints to be as they are
/// between the step's ends. Each was followed along its own way, turning uniformly, which opens a joint by an
/// arm times the turn squared. The first body stays where it is, and the others follow it from joint to
/// joint.
template <class Real>
void find_shifts(WorldData<Real>& w, const std::vector<int>& places, double fraction);

}  // namespace plumb
