#pragma once

#include "engine/solve/body_motion.h"
#include "engine/solve/contact_graph.h"

/// Contacts by sequential impulses as they are taught: Catto, "Iterative dynamics with temporal coherence"
/// (2005) and "Modeling and solving constraints" (2009).
namespace plumb {

template <class Real>
struct SequentialStep {
  Real h = 0, inverse_h = 0;  ///< s, 1/s
  Real warm_start = 1;        ///< this substep over the last one: impulses grow with the time they act in
  Real feedback = 0;          ///< Baumgarte's: share of an overlap that a substep takes back
  Real slop = 0;              ///< s: an overlap is left that the fastest push would take out in this time
  Real bounce_threshold = 0;  ///< m/s; slower impacts do not bounce
};

/// Applies the impulses of the substep before.
template <class Real>
void warm_start_sequentially(BodyMotion<Real>* motion, ContactGraph<Real>& graph,
                             const SequentialStep<Real>& step);

/// One sweep: friction and rolling resistance within what the normal impulses allow, then each point's
/// normal impulse. Before bodies move.
template <class Real>
void sweep_contacts(BodyMotion<Real>* motion, ContactGraph<Real>& graph, const SequentialStep<Real>& step);

/// After bodies have moved: a point that has closed its gap in this substep, and was slowed down for it,
/// closes no more. Keeps the step's largest impulses, for hits.
template <class Real>
void stop_arrivals(BodyMotion<Real>* motion, ContactGraph<Real>& graph, const SequentialStep<Real>& step);

}  // namespace plumb
