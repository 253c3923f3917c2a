#pragma once

#include <algorithm>
#include <limits>

#include "engine/world/ablation/ablation.h"
#include "engine/world/islands/hinge_trees.h"
#include "engine/world/state/constants.h"
#include "engine/world/world_data.h"

/// The choice of how each island is solved: by iterations, its normals directly, or as one system with its
/// friction (jointed_islands.h). Only direct_islands.cpp uses it.
namespace plumb {

template <class Real>
bool is_outside_trees(const WorldData<Real>& w, const JointRecord& joint) {
  const bool a = w.is_dynamic(joint.body_a), b = w.is_dynamic(joint.body_b);
  return joint.active && (a || b) && !in_hinge_tree(w, a ? joint.body_a : joint.body_b);
}

/// Returns the number of active joints that are not part of hinge trees.
template <class Real>
int joints_outside_trees(const WorldData<Real>& w) {
  return w.joint_set.active_count() - w.scratch.islands.trees.hinge_count;
}

/// Returns true if an island with this number of rows is solved directly.
inline bool is_direct(int rows) {
  return enabled(Switch::DirectIslands) && rows > 2 && rows <= tuning::kMaxDirectRows;
}

/// Values of island_size that mark an island with joints. It is solved by iterations (kIterated), as one
/// system (kJointed), or as one system if that costs little (kJointedIfCheap).
inline constexpr int kIterated = tuning::kMaxSlenderRows + 1, kJointed = -1, kJointedIfCheap = -2;

constexpr bool is_jointed(int size) { return size == kJointed || size == kJointedIfCheap; }

/// Returns true for islands of contacts that have too many of them to be solved directly, if all have rows.
/// (A contact counts two rows, so kIterated is none of these.)
constexpr bool is_crowded(int size) { return size > tuning::kMaxDirectRows && size != kIterated; }

/// Returns the separation, m, up to which a contact's points may press without a further approach. The margin
/// of contacts is a fraction of the shapes' extents, so a thin sheet has contacts with several others above
/// and below it. It can press only on the next ones.
template <class Real>
Real near_margin(const WorldData<Real>& w, const ContactConstraint<Real>& c) {
  Real margin = std::numeric_limits<Real>::max();
  for (const int body : {c.body_a, c.body_b})
    if (w.is_dynamic(body))
      margin = std::min({margin, Real(tuning::kSpeculativeMargin) * w.extents[body],
                         Real(2 * tuning::kNearThickness) * w.bodies[body].half_width});
  return margin;
}

/// Returns how far the bodies approach at a point in the time dt, m, at their present velocities.
template <class Real>
Real approach_of(const WorldData<Real>& w, const ContactConstraint<Real>& c, int point, Real dt) {
  const SolverBody<Real>&a = w.motion[c.body_a], &b = w.motion[c.body_b];
  const Real speed = dot(c.normal, b.velocity - a.velocity) + c.arm_b[point] * b.angular_velocity -
                     c.arm_a[point] * a.angular_velocity;
  return std::max(-dt * speed, Real(0));
}

/// Returns true if a point of a contact presses, or is near enough to press in this step.
template <class Real>
bool is_near(const WorldData<Real>& w, const ContactConstraint<Real>& c, int point, Real dt) {
  if (c.normal_impulse[point] > 0 || c.separation[point] <= 0) return true;
  return c.separation[point] <= near_margin(w, c) + approach_of(w, c, point, dt);
}

/// Finds the islands, by their root body, and stores an upper bound of the rows of each in
/// `Scratch::islands.island_size`. Islands with more than tuning::kMaxDirectRows are solved by iterations
/// alone.
template <class Real>
void find_islands(WorldData<Real>& w);

/// Counts the rows of the points that are near enough to press, of the islands that have too many contacts.
/// This is done in each step, since it depends on the motion. Returns true if some have few enough.
template <class Real>
bool choose_crowded(WorldData<Real>& w, Real dt);

/// Returns true if an island of contacts should be solved as one system: if it is small, and its normals and
/// its friction, solved in turn, converge too slowly. They do so where masses differ much, and where friction
/// wedges bodies that move: impulses of an impact that are not yet balanced then act on, which gains energy.
template <class Real>
bool needs_one_system(const WorldData<Real>& w, const DirectIsland<Real>& island, Real dt);

}  // namespace plumb
