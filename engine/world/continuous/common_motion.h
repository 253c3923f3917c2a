#pragma once

#include <vector>

#include "engine/world/world_data.h"

/// Motion of bodies in contact that continuous collision keeps from deepening their overlap. They move on as
/// one rigid body, because stopping them would take away their common motion. Only for continuous.cpp.
namespace plumb {

/// Returns true if a joint holds a body to one that is not dynamic.
template <class Real>
bool is_held_by_joint(const WorldData<Real>& w, int body);

/// Returns true if swept bodies may move together: all are dynamic, on the solver's path or together with
/// others already, and no joint holds one to a body that is not dynamic.
template <class Real>
bool may_move_together(const WorldData<Real>& w, const std::vector<int>& indices);

/// Lets swept bodies move from a fraction of the step to its end as one rigid body, with the sum of their
/// linear and angular momenta. Locked axes of one are locked for all.
template <class Real>
void move_together(WorldData<Real>& w, const std::vector<int>& indices, double fraction);

}  // namespace plumb
