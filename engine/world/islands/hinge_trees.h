#pragma once

#include "engine/world/world_data.h"

/// Articulated bodies: bodies that plain revolute joints connect, without a loop, a contact or another kind
/// of joint. At most one point of a non-dynamic body holds them. Examples are pendulums, hanging chains,
/// levers and trees. The soft and the direct solver move them as in engine/world/joint_solver/hinge_tree.h.
/// Joints in loops, and all bodies with contacts, are left to the other solvers.
namespace plumb {

/// Mark in `Scratch::not_a_tree` of a hinge tree that is left to the iterations because they cost less.
inline constexpr char kLeftToIterations = 2;

/// Finds the hinge trees, if contacts, joints or awake bodies have changed.
template <class Real>
void find_hinge_trees(WorldData<Real>& w);

/// Moves the hinge trees through the step, with the velocity increments of its substeps.
template <class Real>
void move_hinge_trees(WorldData<Real>& w, double h, int substeps);

/// Returns true if the body is part of a hinge tree.
template <class Real>
bool in_hinge_tree(const WorldData<Real>& w, int body) {
  return !w.scratch.islands.trees.empty() && w.scratch.islands.trees.is_link[body] != 0;
}

}  // namespace plumb
