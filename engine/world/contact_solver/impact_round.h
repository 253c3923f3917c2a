#pragma once

#include "engine/world/contact_solver/impact_scratch.h"

namespace plumb {

/// Resolves the impacts of a round, `scratch.points`, by groups that share no dynamic body, and corrects the
/// displacements. Subtracts each solved point from `work_left`. `max_approach`: the fastest approach of the
/// substep, m/s; changes below 1e-6 of it count as converged.
template <class Real>
void resolve_round(SolverBody<Real>* motion, Rotation<Real>* rotation, Real max_approach, int& work_left,
                   ImpactScratch<Real>& scratch);

}  // namespace plumb
