#pragma once

#include "engine/world/world_data.h"

/// The user's pre-solve hook in continuous collision, for impacts between shapes that had no contact points
/// before the step was solved.
namespace plumb {

/// Returns true if the hook has disabled the contact of two shapes in this step: they pass through each
/// other.
template <class Real>
bool is_disabled_pair(const WorldData<Real>& w, int shape, int other) {
  return w.disabled_pairs.size() > 0 && w.disabled_pairs.contains(shape, other);
}

/// Returns true if the hook lets the shapes of an impact pass through each other in this step. Calls it at
/// most once per step for the same shapes, with their contact and bodies as they are at the impact: `a` with
/// its `shape`, and `b` with `other` (null: does not move). Contacts with points, and impacts that were
/// expected, were decided before the step was solved.
template <class Real>
bool is_disabled_impact(WorldData<Real>& w, const SweptBody& a, int shape, const SweptBody* b, int other,
                        double fraction);

}  // namespace plumb
