#pragma once

#include "engine/world/contact_solver/impact_scratch.h"

namespace plumb {

/// Resolves the impacts of a round, the points of `room.struck`, by groups that share no dynamic body, and
/// corrects the displacements. Each point counts against `looks`. `fastest` is the fastest approach of the
/// substep, m/s: what changes by less than 1e-6 of it has converged.
template <class Real>
void resolve_round(BodyMotion<Real>* motion, Rotation<Real>* rotation, Real fastest, int& looks,
                   ImpactScratch<Real>& room);

}  // namespace plumb
