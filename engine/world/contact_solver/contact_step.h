#pragma once

#include "engine/world/contact_solver/solver_body.h"

namespace plumb {

/// Settings of the passes over contacts.
template <class Real>
struct ContactStep {
  Real h = 0, inverse_h = 0;        ///< s, 1/s, of the substep
  Softness<Real> softness[5][2]{};  ///< by ContactHardness; first of overlaps, then of gaps (not softened)
  Real warm_start = 1;          ///< ratio of this substep's length to the last one's: impulses scale with it
  Real bounce_threshold = 0;    ///< m/s; slower impacts do not bounce
  Real load_push_fraction = 0;  ///< fraction of the velocity change by a load that is added to the
                                ///< depenetration speed of soft contacts
};

}  // namespace plumb
