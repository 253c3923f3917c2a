#pragma once

#include <vector>

#include "engine/world/contact_solver/impact_scratch.h"

namespace plumb {

/// Finds the impacts of a substep. Returns false if there are none, or if even the first round would exceed
/// the work limit of `propagate_impacts`. In this case all impacts are left to the constraints.
template <class Real>
bool find_impacts(const SolverBody<Real>* motion, const std::vector<RestitutionContact<Real>>& bounces,
                  ImpactScratch<Real>& scratch);

/// Links the contacts of each group of bodies for all substeps of a step, which have the same contacts and
/// groups. `scratch.group` must be filled in.
template <class Real>
void link_contacts(const SolverBody<Real>* motion, const std::vector<RestitutionContact<Real>>& bounces,
                   ImpactScratch<Real>& scratch);

/// Resolves the impacts of a substep by impact propagation. A body with an impact passes it on to others that
/// it touches or is about to touch (the break of a rack). Runs before the constraints are solved, in rounds.
/// Each round resolves the earliest impacts. Simultaneous ones are resolved together by Newton's law, (n.v)'
/// = -e n.v, with lambda >= 0, and then by friction, at most as much as stops the sliding. The impulses of a
/// round change the energy by the sum of lambda (n.v + (n.v)') / 2. If iterations have not converged, the
/// impulses are scaled back until this is not positive, so no round gains energy. Impacts of a round that
/// share no dynamic body, directly or by joints, are solved separately. The first round examines the contacts
/// that `schedule_impacts` has marked, each later one the contacts of bodies with an impact in the last
/// round: the cost depends on the number of impacts, not of contacts. Joints propagate impacts at once: in
/// each round the rows of a group's joints have impulses such that none of their rates changes, J M^-1 (J^T
/// mu + N^T lambda) = 0. The impulses mu do no work.
///
/// An impulse at the time t displaces a body by (h - t) times the change of velocity. The excess over the
/// whole substep's motion is subtracted from the position.
///
/// Returns the number of rounds. Stops if no time passes for many rounds, and leaves the rest to the
/// constraints: between two walls that both push, a body would bounce for ever.
template <class Real>
int propagate_impacts(SolverBody<Real>* motion, Rotation<Real>* rotation,
                      std::vector<RestitutionContact<Real>>& bounces, const ContactStep<Real>& step,
                      ImpactScratch<Real>& scratch);

}  // namespace plumb
