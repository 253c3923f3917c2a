#pragma once

#include "engine/world/world_data.h"

/// Sleeping: bodies that are tied to each other by contacts and joints (an island) stop being computed
/// together when all of them have been still for long enough, and start again together.
namespace plumb {

/// Wakes the body and all that it holds or is held by, as far as dynamic bodies reach: one that is kinematic
/// wakes alone. Nothing happens to bodies that are awake or static. Where memory is out, all sleep on.
template <class Real>
void wake_body(WorldData<Real>& w, int body);

/// Wakes whatever touches the body or is joined to it, and the body.
template <class Real>
void wake_neighbours(WorldData<Real>& w, int body);

/// Puts islands to sleep whose bodies are all still. They are looked for only when some body could sleep.
template <class Real>
void sleep_islands(WorldData<Real>& w);

/// Puts the body's whole island to sleep at once.
template <class Real>
void put_to_sleep(WorldData<Real>& w, int body);

/// Takes one body out of the motion; what ties it to others is the caller's business.
template <class Real>
void fall_asleep(WorldData<Real>& w, int body);

/// Puts a body into the list of awake ones, or takes it out; nothing else.
template <class Real>
void enter_awake(WorldData<Real>& w, int body);
template <class Real>
void leave_awake(WorldData<Real>& w, int body);

}  // namespace plumb
