#pragma once

#include "engine/world/contact_solver/contact_pair.h"
#include "engine/world/world_data.h"

/// The solvers of a world, one file each. Each advances the awake bodies by `substeps` substeps of length
/// `h`, and leaves the last impulses in contacts and joints.
namespace plumb {

/// Adds the normal impulses of a substep to the step's sums of the contacts that record them.
template <class Real>
void add_step_impulses(WorldData<Real>& w) {
  w.graph.for_each([](ContactConstraint<Real>& c) {
    if (c.tracking != ImpactTracking::Off) c.step_impulse += normal_sum(c);
  });
}

/// Solves by soft constraints (Catto, 2024). With Solver::Direct, also solves islands with joints directly.
template <class Real>
void solve_soft_steps(WorldData<Real>& w, double h, int substeps);

/// Solves by sequential impulses (Catto, 2005).
template <class Real>
void solve_sequential_impulses(WorldData<Real>& w, double h, int substeps);

/// Solves by projection of positions (Jakobsen, 2001).
template <class Real>
void solve_jakobsen(WorldData<Real>& w, double h, int substeps);

/// Solves by extended position-based dynamics (Macklin, Mueller and Chentanez, 2016; Mueller et al., 2020).
template <class Real>
void solve_xpbd(WorldData<Real>& w, double h, int substeps);

}  // namespace plumb
