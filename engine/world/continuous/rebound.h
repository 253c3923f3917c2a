#pragma once

#include "engine/world/world_data.h"

namespace plumb {

/// In `Scratch::loaded`, during continuous collision: a contact may hold the body; its velocity decides.
inline constexpr char kMayHold = 2;

/// Returns the trajectory of a body in a step of `dt`, as computed by the solver.
template <class Real>
SweptBody flight_of(const WorldData<Real>& w, int body, double dt);

/// Returns the body's flight if it has had, or is to have, an impact in it; else null.
template <class Real>
const SweptBody* flight_in(const WorldData<Real>& w, int body) {
  if (w.scratch.swept_body_places.size() <= static_cast<std::size_t>(body)) return nullptr;
  const int place = w.scratch.swept_body_places[body];
  return place == kNone ? nullptr : &w.scratch.swept_bodies[place];
}

/// Returns true if neither a joint, a lock, a pre-solve hook nor a pressing contact holds the bodies of two
/// shapes in this step of `dt`, s. Only then may a flight have an impact within the step.
template <class Real>
bool may_rebound(const WorldData<Real>& w, int shape, int other, double dt);

/// Resolves an impact in flight: `a` with its `shape`, and `b` with its `other` (null: it does not move),
/// continue from a fraction of the step. Their velocities follow from Newton's and Coulomb's laws; approaches
/// too slow to bounce slide along the surface. After the last impact that the step has room for (`is_last`)
/// no point of the contact approaches any more. Returns false and does nothing if they do not approach.
template <class Real>
bool rebound(WorldData<Real>& w, SweptBody& a, int shape, SweptBody* b, int other, double fraction, double dt,
             bool is_last);

/// Moves a body to the end of its flight.
template <class Real>
void land(WorldData<Real>& w, const SweptBody& flight);

}  // namespace plumb
