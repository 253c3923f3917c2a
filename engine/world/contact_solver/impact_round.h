#pragma once

#include "engine/world/contact_solver/impact_scratch.h"

namespace plumb {

/// Resolves the impacts of a round, `scratch.points`, by groups that share no dynamic body, and corrects the
/// displacements. Subtracts each solved point from `work_left`. `max_approach`: the fastest approach of the
/// substep, m/s; changes below 1e-6 of it count as converged.
template <class Real>
void resolve_round(SolverBody<Real>* motion, Rotation<Real>* rotation, Real max_approach, int& work_left,
                   ImpactScratch<Real>& scratch);

/// Removes from the velocities of a group of bodies what their joints forbid, as the joints would in the next
/// substep. Rigid rows keep their rates in an impact, so that one that is not 0 would do work in it.
template <class Real>
void stop_joint_rates(SolverBody<Real>* motion, Rotation<Real>* rotation, int group,
                      ImpactScratch<Real>& scratch);

}  // namespace plumb
