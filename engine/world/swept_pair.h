#pragma once

#include "engine/world/world_data.h"

namespace plumb {

/// What all searches for impacts in a step share.
struct ImpactSearch {
  double dt = 0;          ///< s, the step
  int long_searches = 0;  ///< iterations left, see kLongSearches
};

/// The rest of a body's way in this step, from a fraction of it on, seen from where it starts.
struct Way {
  Way(const Flight& flight_, double from_, ImpactSearch& search_)
      : flight(flight_),
        from(from_),
        origin(flight_.start_at(from_)),
        sweep(flight_.sweep(from_, origin)),
        search(search_) {}
  const Flight& flight;
  double from;
  Vec2d origin;
  Sweep<double> sweep;
  ImpactSearch& search;
};

/// Of a pair of shapes, what is known beforehand.
template <class Real>
struct SweptPair {
  int shape = 0, other = 0;                          ///< `shape` is that of the body on its way
  const ContactConstraint<Real>* contact = nullptr;  ///< what the solver had between the two; null: nothing
  bool stands = false;  ///< the other one was stopped before it: it may get into that by what either bears
};

/// The fraction of the step at which a body on its way has to be stopped, or thrown back, before another
/// shape; 1 when it passes nothing. Not a touch decides, but the core (convex_core.h): as long as nothing
/// gets to that, contacts push shapes apart again on the sides that they came from.
template <class Real>
double fraction_of_impact(const WorldData<Real>& w, const Way& way, const SweptPair<Real>& pair);

}  // namespace plumb
