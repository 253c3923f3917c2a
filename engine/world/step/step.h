#pragma once

#include "engine/world/world_data.h"

/// One step of the real-time world, and its stages, one file each.
namespace plumb {

/// Advances the world by `dt` in `substeps` substeps.
template <class Real>
void step_world(WorldData<Real>& w, double dt, int substeps);

/// Does what an exception does on its way out of `step_world`, for a step that was left where nothing
/// unwinds: in WebAssembly.
template <class Real>
void end_interrupted_step(WorldData<Real>& w);

/// Broad phase: creates contacts for shapes whose fat AABBs started to overlap.
template <class Real>
void find_pairs(WorldData<Real>& w, Real dt);

/// Narrow phase: updates manifolds of shapes that touch, or may touch within `dt`; substeps have length `h`.
template <class Real>
void update_contacts(WorldData<Real>& w, Real dt, Real h);

/// Solves velocities and motion of the awake bodies over `substeps` substeps of length `h`, by the world's
/// solver.
template <class Real>
void solve_motion(WorldData<Real>& w, double h, int substeps);

/// Applies the solver's motion to the bodies and updates their AABBs. Quarantines bodies with an invalid
/// motion.
template <class Real>
void finalize_bodies(WorldData<Real>& w, Real dt);

/// Moves fast bodies back to their first time of impact.
template <class Real>
void solve_continuous(WorldData<Real>& w, Real dt);

/// Updates sensor overlaps and emits begin and end events.
template <class Real>
void update_sensors(WorldData<Real>& w);

/// Reports shapes with an impact in this step as touching, and hard impacts of shapes with hit events.
template <class Real>
void report_impacts(WorldData<Real>& w);

/// Removes joints whose mean force or torque in the step exceeds their limit, and reports loads.
template <class Real>
void break_joints(WorldData<Real>& w);

}  // namespace plumb
