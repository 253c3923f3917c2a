#pragma once

#include "engine/world/world_data.h"

namespace plumb {

/// Value in `Scratch::loaded` during continuous collision: a contact may hold the body, depending on its
/// velocity.
inline constexpr char kMayHold = 2;

/// Returns the trajectory of a body in a step of `dt`, as computed by the solver.
template <class Real>
SweptBody flight_of(const WorldData<Real>& w, int body, double dt);

/// Returns the body's flight if it had an impact within the step or will have one; else null.
template <class Real>
const SweptBody* flight_in(const WorldData<Real>& w, int body) {
  if (w.scratch.swept_body_places.size() <= static_cast<std::size_t>(body)) return nullptr;
  const int place = w.scratch.swept_body_places[body];
  return place == kNone ? nullptr : &w.scratch.swept_bodies[place];
}

/// Returns true if no joint, lock, pre-solve hook or pressing contact holds the bodies of two shapes in this
/// step of `dt`, s. Only then may a flight have an impact within the step.
template <class Real>
bool may_rebound(const WorldData<Real>& w, int shape, int other, double dt);

/// Resolves an impact in flight of `a` with its `shape` and `b` with its `other` (null: does not move), which
/// then continue from a fraction of the step. Their velocities follow from Newton's and Coulomb's laws; an
/// approach too slow to bounce becomes sliding along the surface. After the last impact that the step allows
/// (`is_last`) no point of the contact approaches any more. Returns false and changes nothing if the bodies
/// do not approach.
template <class Real>
bool rebound(WorldData<Real>& w, SweptBody& a, int shape, SweptBody* b, int other, double fraction, double dt,
             bool is_last);

/// Moves a body to the end of its flight.
template <class Real>
void land(WorldData<Real>& w, const SweptBody& flight);

}  // namespace plumb
