#pragma once

#include "engine/world/contact_solver/contact_graph.h"
#include "engine/world/contact_solver/solver_body.h"

/// Contacts by textbook sequential impulses: Catto, "Iterative dynamics with temporal coherence" (2005) and
/// "Modeling and solving constraints" (2009).
namespace plumb {

template <class Real>
struct SequentialStep {
  Real h = 0, inverse_h = 0;  ///< s, 1/s
  Real warm_start = 1;        ///< ratio of this substep's length to the last one's: impulses scale with it
  Real bounce_threshold = 0;  ///< m/s; slower impacts do not bounce
};

/// Applies the impulses of the last substep.
template <class Real>
void warm_start_sequentially(SolverBody<Real>* motion, ContactGraph<Real>& graph,
                             const SequentialStep<Real>& step);

/// Makes one iteration before bodies move: friction and rolling resistance within the bounds of the normal
/// impulses, then each point's normal impulse.
template <class Real>
void iterate_contacts(SolverBody<Real>* motion, ContactGraph<Real>& graph, const SequentialStep<Real>& step);

/// Stops points that have closed their gap in this substep and still approach, because the solver let the gap
/// close. Runs after the bodies have moved. Records the step's largest impulses, for hit events.
template <class Real>
void stop_closed_gaps(SolverBody<Real>* motion, ContactGraph<Real>& graph, const SequentialStep<Real>& step);

}  // namespace plumb
