#pragma once

#include "engine/scene/scene.h"

namespace plumb {

/// Frequencies, rad/s, of what hangs on hinges from the fixed frame without a loop; 0 where nothing does.
struct HingeModes {
  /// Of the fastest body that nothing hangs on, to and fro on its hinge: w^2 = m g r / (I + m r^2).
  double pendulum = 0;
  /// Of the fastest hinge to and fro between its two links, taut under what hangs below: of three times what
  /// it would be with its neighbours fixed, as where hinges of a uniform chain move against each other,
  /// w^2 = 12 T / (m l).
  double link = 0;
};

/// At rest. The scene is valid.
HingeModes hinge_modes(const Scene& scene);

}  // namespace plumb
