#pragma once

#include "engine/solve/soft_contacts.h"
#include "engine/world/world_data.h"

/// Islands with joints, solved as one: the rows of all their joints (points, welds, limits, motors, springs)
/// and contacts (normals, friction, rolling) are one complementarity problem, engine/solve/bounded_rows.h.
/// docs/decisions/jointed-islands.md says why. A substep h is
///     q_m = q_0 + h/2 v_0             rows at q_m
///     v' = v_0 + h M^-1 f + M^-1 J_m^T x,   J_m (v_0 + v')/2 = 0
///     q_1 = q_0 + h (v_0 + v')/2      rows at q_1
///     v_1 = v' + M^-1 J_1^T y,        J_1 v_1 = 0
/// The way is made with the mean of two velocities that both ends' constraints allow, so that the impulses x
/// do no work, whatever the rows are: the kinetic energy changes by h f . (v_0 + v')/2, the work of the
/// forces. The second solution is a projection, which can only take energy. It takes little, as v' is what
/// v_0 is when it is reflected: of third order in h.
namespace plumb {

/// Chooses them and orders their rows, at the start of a step. Islands have been found.
template <class Real>
void prepare_jointed_islands(WorldData<Real>& w);

/// Notes velocities at the substep's start, before forces act.
template <class Real>
void begin_jointed_substep(WorldData<Real>& w);

/// Notes velocities with the forces' part, before any impulse.
template <class Real>
void note_free_velocities(WorldData<Real>& w);

/// Impacts at their time within the substep have changed velocities since, and bodies' places accordingly:
/// the way goes on as if they had had the new ones from its start.
template <class Real>
void note_blows(WorldData<Real>& w);

/// Finds the impulses of the way, and leaves its velocity in the bodies.
template <class Real>
void hold_jointed_islands(WorldData<Real>& w, const ContactStep<Real>& step);

/// After the motion: velocities that fit where bodies are; before that, to `close` gaps, bodies are moved.
template <class Real>
void relax_jointed_islands(WorldData<Real>& w, const ContactStep<Real>& step, bool close);

}  // namespace plumb
