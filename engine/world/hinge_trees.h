#pragma once

#include "engine/world/world_data.h"

/// Mechanisms: bodies that plain revolute joints tie to each other, and to at most one point of what does not
/// give way, without a loop, a contact or another joint: pendulums, hanging chains, levers, trees. They are
/// moved as what they are, engine/solve/hinge_tree.h says how, by the soft steps and the direct ones. Joints
/// that close a loop, and all of what touches something, are left to the other solvers.
namespace plumb {

/// Finds them where ties have changed.
template <class Real>
void find_hinge_trees(WorldData<Real>& w);

/// Moves them through the step. Kicks are those of its substeps.
template <class Real>
void move_hinge_trees(WorldData<Real>& w, double h, int substeps);

/// Whether a mechanism moves the body.
template <class Real>
bool in_hinge_tree(const WorldData<Real>& w, int body) {
  return !w.scratch.trees.empty() && w.scratch.trees.holds[body] != 0;
}

}  // namespace plumb
