#pragma once

#include <vector>

#include "engine/world/world_data.h"

/// Bodies connected by joints that continuous collision stops at the same time. Only for continuous.cpp.
namespace plumb {

/// Removes from bodies that are stopped together at a fraction of the step the work of forces in the rest of
/// it, because forces do no work on a body that does not move. Otherwise a mechanism that hangs on its
/// obstacle would gain speed from step to step without moving. Keeps the impulses of contacts, and so
/// momentum.
template <class Real>
void take_unmoved_work(WorldData<Real>& w, const std::vector<int>& places, double fraction, double dt);

/// Sets the displacements of bodies that are stopped together for which their joints are as far open or
/// closed as at the step's ends. Each body was stopped on its own path with uniform rotation, which opens a
/// joint by an arm times the angle squared. The first body stays in place, and the others follow it from
/// joint to joint.
template <class Real>
void find_shifts(WorldData<Real>& w, const std::vector<int>& places, double fraction);

}  // namespace plumb
