#pragma once

#include "engine/world/contact_solver/contact_graph.h"
#include "engine/world/contact_solver/solver_body.h"

/// Position-based contacts: overlaps are removed by displacing bodies. Within a substep a body's velocity is
/// its displacement since the start over h. A displacement by dx changes the velocity by dx / h, and the
/// multiplier over h is an impulse.
namespace plumb {

template <class Real>
struct PositionStep {
  Real h = 0, inverse_h = 0;  ///< s, 1/s, of the substep
  Real bounce_threshold = 0;  ///< m/s; slower impacts do not bounce
};

/// Friction law of the position solver.
enum class PositionFriction {
  Coulomb,  ///< removes sliding up to mu times the normal multiplier (Jakobsen, 2001)
  Static,   ///< removes it completely or not at all; the velocity pass does the rest (Mueller et al., 2020)
};

/// Clears impulses at the start of a substep, before forces act. Updates the approach of points that have had
/// no impulse in this step.
template <class Real>
void prepare_position_contacts(SolverBody<Real>* motion, ContactGraph<Real>& graph);

/// Makes one iteration over predicted positions: removes overlaps, no faster than the depenetration speed,
/// then sliding. Updates positions, rotations and velocities.
template <class Real>
void project_contacts(SolverBody<Real>* motion, Rotation<Real>* rotation, ContactGraph<Real>& graph,
                      const PositionStep<Real>& step, PositionFriction friction);

/// Corrects velocities after the projection. Points with a fast impact separate with restitution times their
/// approach, and no point with an impulse continues to close.
template <class Real>
void apply_restitution(SolverBody<Real>* motion, ContactGraph<Real>& graph, const PositionStep<Real>& step);

/// Does the same as `apply_restitution`, and removes the separating velocity of other points with an impulse
/// (Mueller et al., 2020, section 3.6). Then applies dynamic friction, |dv| <= mu lambda_n / m.
template <class Real>
void correct_contact_velocities(SolverBody<Real>* motion, ContactGraph<Real>& graph,
                                const PositionStep<Real>& step);

}  // namespace plumb
