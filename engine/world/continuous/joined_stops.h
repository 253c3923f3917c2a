#pragma once

#include <vector>

#include "engine/world/world_data.h"

/// Bodies connected by joints that continuous collision stops at the same time. Only for continuous.cpp.
namespace plumb {

/// Removes the work of forces over the rest of the step from bodies that are stopped together at a fraction
/// of it, because forces do no work on a body at rest. Otherwise a mechanism that hangs on its obstacle would
/// gain speed from step to step. Keeps the impulses of contacts, and so momentum.
template <class Real>
void remove_remaining_work(WorldData<Real>& w, const std::vector<int>& indices, double fraction, double dt);

/// Sets the `joint_correction` of bodies that are stopped together, so that their joints have the gaps of the
/// step's ends, interpolated. Each body was stopped on its own path with uniform rotation, which opens a
/// joint by an arm times the angle squared. The first body stays, and the others follow joint by joint.
template <class Real>
void find_joint_corrections(WorldData<Real>& w, const std::vector<int>& indices, double fraction);

}  // namespace plumb
