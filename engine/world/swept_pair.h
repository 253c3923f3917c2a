#pragma once

#include "engine/world/world_data.h"

namespace plumb {

/// The rest of a body's way in this step, from a fraction of it on, seen from where it starts.
struct Way {
  Way(const Flight& flight_, double from_, int& long_searches_)
      : flight(flight_),
        from(from_),
        origin(flight_.start_at(from_)),
        sweep(flight_.sweep(from_, origin)),
        long_searches(long_searches_) {}
  const Flight& flight;
  double from;
  Vec2d origin;
  Sweep<double> sweep;
  int& long_searches;  // iterations left to all of the step, see kLongSearches
};

/// The fraction of the step at which `shape` of a body on its way has to be stopped before `other`, or thrown
/// back; 1 when it passes nothing. Not a touch decides, but the core (convex_core.h): as long as nothing gets
/// to that, contacts push shapes apart again on the sides that they came from. `contact`: what the solver had
/// between the two in this step; may be null.
template <class Real>
double fraction_of_impact(const WorldData<Real>& w, const Way& way, int shape, int other,
                          const ContactConstraint<Real>* contact);

}  // namespace plumb
