#pragma once

#include <vector>

#include "engine/world/contact_solver/impact_scratch.h"

namespace plumb {

/// Finds the impacts of a substep. Returns false if there are none, or if even the first round would exceed
/// the work limit of `propagate_impacts`: then all impacts are left to the constraints.
template <class Real>
bool find_impacts(const SolverBody<Real>* motion, const std::vector<RestitutionContact<Real>>& bounces,
                  ImpactScratch<Real>& room);

/// Links the contacts of each group of bodies for all substeps of a step, which have the same contacts and
/// groups. `room.group` must be filled in.
template <class Real>
void link_contacts(const SolverBody<Real>* motion, const std::vector<RestitutionContact<Real>>& bounces,
                   ImpactScratch<Real>& room);

/// Resolves the impacts of a substep by impact propagation. A body with an impact passes it on to others that
/// it touches or is about to touch (the break of a rack). Runs before the constraints are solved, in rounds.
/// Each resolves the earliest impacts; simultaneous ones are resolved together by Newton's law, (n.v)' = -e
/// n.v. With lambda >= 0 the impulses of a round change its energy by the sum of lambda (n.v + (n.v)') / 2.
/// Impulses of iterations that have not converged are scaled back until this is not positive, so no round
/// gains energy. Friction follows, at most as much as stops the sliding. Impacts of a round that share no
/// dynamic body, directly or by joints, are solved apart. A round examines only contacts of bodies that the
/// last one has struck, and the first one those that `schedule_impacts` has marked: the cost depends on the
/// number of impacts, not on the size of the crowd.
/// Joints pass impacts on at once: in each round the rows of a group's joints have impulses such that none of
/// their rates changes, J M^-1 (J^T mu + N^T lambda) = 0. The impulses mu do no work.
///
/// An impulse at the time t displaces a body by (h - t) times the change in velocity. The excess of the
/// substep's motion is subtracted from the position.
///
/// Returns the number of rounds. If no time passes for many rounds, it stops and leaves the rest to the
/// constraints. Between two walls that both push, a body would bounce for ever.
template <class Real>
int propagate_impacts(SolverBody<Real>* motion, Rotation<Real>* rotation,
                      std::vector<RestitutionContact<Real>>& bounces, const ContactStep<Real>& step,
                      ImpactScratch<Real>& room);

}  // namespace plumb
