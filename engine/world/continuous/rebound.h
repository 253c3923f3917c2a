#pragma once

#include "engine/world/world_data.h"

namespace plumb {

/// Value in `Scratch::loaded` during continuous collision: depending on its velocity, a contact supports the
/// body.
inline constexpr char kMayHold = 2;

/// Returns the solver's motion of a body in a step of `dt`, s.
template <class Real>
SweptBody swept_body_of(const WorldData<Real>& w, int body, double dt);

/// Returns the SweptBody of a body, or null if continuous collision has none for it.
template <class Real>
const SweptBody* find_swept_body(const WorldData<Real>& w, int body) {
  if (w.scratch.continuous.swept_index_of.size() <= static_cast<std::size_t>(body)) return nullptr;
  const int index = w.scratch.continuous.swept_index_of[body];
  return index == kNone ? nullptr : &w.scratch.continuous.swept_bodies[index];
}

/// Returns true if no joint, lock or loaded contact acts on the bodies of two shapes in this
/// step of `dt`, s. Only then is their impact resolved within the step; otherwise bodies are stopped.
template <class Real>
bool may_resolve_toi_impact(const WorldData<Real>& w, int shape, int other, double dt);

/// Returns true if two bodies stay together after an impact: both are dynamic, without restitution.
template <class Real>
bool stay_together(const WorldData<Real>& w, int shape, int other);

/// Says how an impact in flight was resolved.
struct ToiResponse {
  bool resolved = false;  ///< it set the velocities of the bodies
  double approach = 0;    ///< m/s, velocity along the normal that it removed
};

/// Resolves the impact of `a` with its `shape` and `b` with its `other` (null: does not move), which then
/// continue from a fraction of the step. Their velocities follow from Newton's and Coulomb's laws; after an
/// approach too slow to bounce, the body slides along the surface. After the last impact of the step
/// (`is_last`) no contact point approaches any more. Returns false and changes nothing if the bodies do not
/// approach.
template <class Real>
ToiResponse resolve_toi_impact(WorldData<Real>& w, SweptBody& a, int shape, SweptBody* b, int other,
                               double fraction, double dt, bool is_last);

/// Writes the end of the swept motion to the body.
template <class Real>
void commit_sweep(WorldData<Real>& w, const SweptBody& swept);

}  // namespace plumb
