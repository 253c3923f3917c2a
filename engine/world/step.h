#pragma once

#include "engine/world/world_data.h"

/// One step of the real-time world, and the stages that it consists of, a file each.
namespace plumb {

/// Advances the world by `dt` in `substeps` substeps.
template <class Real>
void step_world(WorldData<Real>& w, double dt, int substeps);

/// Broad phase: makes contacts for shapes whose stored boxes have come to overlap.
template <class Real>
void find_pairs(WorldData<Real>& w);

/// Narrow phase: where shapes touch, or may within `dt`, of substeps of length `h`.
template <class Real>
void update_contacts(WorldData<Real>& w, Real dt, Real h);

/// Velocities and motion of the awake bodies over `substeps` substeps of length `h`, by the world's solver.
template <class Real>
void solve_motion(WorldData<Real>& w, double h, int substeps);

/// Moves the bodies by what the solver found, and their boxes with them. What is not to be moved so is
/// quarantined.
template <class Real>
void finish_motion(WorldData<Real>& w, Real dt);

/// Brings fast bodies back to where they first met something on their way.
template <class Real>
void stop_at_impacts(WorldData<Real>& w, Real dt);

/// Compares what overlaps the sensors with what did before.
template <class Real>
void update_sensors(WorldData<Real>& w);

/// Reports what has struck in this step as touching, and hard impacts of shapes that want it.
template <class Real>
void report_impacts(WorldData<Real>& w);

/// Takes out joints whose force or torque is beyond what they bear.
template <class Real>
void break_joints(WorldData<Real>& w, double h);

/// The tight box of a shape where its body is now.
template <class Real>
Aabb<Real> box_of(const WorldData<Real>& w, int shape);

/// What is stored for it in the tree: the box with a margin and room for the motion of the next steps.
template <class Real>
Aabb<Real> stored_box(const WorldData<Real>& w, int shape, Real dt);

/// Brings a shape's boxes up to date where its body is now, after it turned such that no point of it moved by
/// more than `turned`, m. Returns whether its stored box held it all the way.
template <class Real>
bool refresh_box(WorldData<Real>& w, int shape, Real dt, Real turned);

}  // namespace plumb
