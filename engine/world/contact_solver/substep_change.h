#pragma once

namespace plumb {

/// Change of a body's velocity in its last substep: solvers/struck_bodies.h.
template <class Real>
struct SubstepChange {
  Real speed = 0;       ///< m/s, its magnitude, with that of the farthest point by rotation
  bool struck = false;  ///< it came suddenly: by an impact
};

}  // namespace plumb
