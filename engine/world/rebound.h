#pragma once

#include "engine/world/world_data.h"

namespace plumb {

/// The way of a body in a step of `dt`, as the solver had it.
template <class Real>
Flight flight_of(const WorldData<Real>& w, int body, double dt);

/// The one that it has had an impact in, or is to have; null when there is none.
template <class Real>
const Flight* flight_in(const WorldData<Real>& w, int body) {
  if (w.scratch.flight_places.size() <= static_cast<std::size_t>(body)) return nullptr;
  const int place = w.scratch.flight_places[body];
  return place == kNone ? nullptr : &w.scratch.flights[place];
}

/// Whether two shapes part again after an impact, and nothing else holds their bodies in this step: no joint,
/// no contact that presses. Then a flight may be thrown back on its way.
template <class Real>
bool may_rebound(const WorldData<Real>& w, int shape, int other);

/// Resolves an impact in flight: `a`, with its `shape`, and `b` (none: what does not move), with its `other`,
/// go on from a fraction of the step with the velocities that Newton's and Coulomb's laws give them. What
/// comes too slowly to bounce slides on along the surface. False, and nothing happens, when they do not
/// approach.
template <class Real>
bool rebound(WorldData<Real>& w, Flight& a, int shape, Flight* b, int other, double fraction, double dt);

/// Puts a body where its flight has brought it.
template <class Real>
void land(WorldData<Real>& w, const Flight& flight);

}  // namespace plumb
