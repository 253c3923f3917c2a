#pragma once

#include "engine/world/contact_solver/contact_step.h"
#include "engine/world/world_data.h"

/// Islands with joints, solved as one system. The rows of all their joints (points, welds, limits, motors,
/// springs) and contacts (normals, friction, rolling) are one complementarity problem,
/// engine/linear_algebra/bounded_rows.h. Reasons: docs/decisions/jointed-islands.md. A substep h is
///     q_m = q_0 + h/2 v_0             rows at q_m
///     v' = v_0 + h M^-1 f + M^-1 J_m^T x,   J_m (v_0 + v')/2 = 0
///     q_1 = q_0 + h (v_0 + v')/2      rows at q_1
///     v_1 = v' + M^-1 J_1^T y,        J_1 v_1 = 0
/// Bodies move with the mean of v_0 and v', which satisfies the constraints at q_m. So the impulses x do no
/// work, whatever the rows are: the kinetic energy changes by h f . (v_0 + v')/2, the work of the forces. The
/// second solve is a projection, which can only take energy. It takes little, of third order in h, because v'
/// is v_0 reflected.
namespace plumb {

/// Orders the rows of a new island. Returns the multiplications of their factorisation.
template <class Real>
double order_jointed_island(WorldData<Real>& w, JointedIsland<Real>& island);

/// Loads the impulses from which an island's next solution starts: those that its joints and contacts store.
template <class Real>
void load_impulses(JointedIsland<Real>& island);

/// Finds the bodies of the islands at the start of a step. Islands must be chosen and ordered before.
template <class Real>
void prepare_jointed_islands(WorldData<Real>& w);

/// Stores the velocities at the substep's start, before forces act.
template <class Real>
void begin_jointed_substep(WorldData<Real>& w);

/// Stores the velocities after forces, before any impulse.
template <class Real>
void save_free_velocities(WorldData<Real>& w);

/// Updates the stored velocities after impacts within the substep. Impacts also move the bodies, so the
/// displacement of the substep continues as if the new velocities had held from its start.
template <class Real>
void add_impact_velocities(WorldData<Real>& w);

/// Finds the impulses x, and sets the bodies' velocities to those of the displacement, (v_0 + v')/2.
template <class Real>
void solve_jointed_islands(WorldData<Real>& w, const ContactStep<Real>& step);

/// Finds the impulses y after the motion, so that velocities satisfy the constraints. In the `last` substep
/// (with Solver::Direct in every substep) first moves bodies to close gaps.
template <class Real>
void relax_jointed_islands(WorldData<Real>& w, const ContactStep<Real>& step, bool last);

}  // namespace plumb
