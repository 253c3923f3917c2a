#pragma once

#include "engine/world/world_data.h"

/// Contacts of kinematic bodies that move. Such a body presses with any force. Where it presses bodies
/// against others that do not give way, the rows of contacts contradict each other: rigid rows then move a
/// body out at the speed of the press over a small angle, and impulses that only squeeze grow from substep to
/// substep, until rows turn and they no longer balance. So these contacts yield (ContactHardness::Driven) to
/// what their impulse exceeds a load.
namespace plumb {

/// Marks them, at the start of a step. Returns true if there are any.
template <class Real>
bool mark_driven_contacts(WorldData<Real>& w);

/// Sets the load that each of them bears without yielding: the last impulse (or all forces on its island in a
/// substep, if that is less; on all bodies, as long as islands are not known), and the impulse that stops the
/// approach of its two bodies if nothing else holds them.
template <class Real>
void set_driver_loads(WorldData<Real>& w);

/// Ends their marks.
template <class Real>
void unmark_driven_contacts(WorldData<Real>& w);

}  // namespace plumb
