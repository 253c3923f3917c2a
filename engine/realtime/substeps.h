#pragma once

#include <string>

#include "engine/driver/accuracy.h"
#include "engine/scene/scene.h"

namespace plumb {

/// Into how many equal substeps a step is divided, and why.
struct SubstepPlan {
  double count = 1;  ///< a whole number; more than kMostNeeded are refused, unless asked for
  std::string why{};
};

/// Most substeps of a step, asked for; and needed: a step of more is no step any more.
inline constexpr int kMostSubsteps = 1000000, kMostNeeded = 100000;

/// Returns the requested substeps, or more if velocity Verlet needs them for the scene's known frequencies w:
/// of springs, pendulums, and light links that carry a heavy load. Its error is (w h)^2/4 of a mode's energy;
/// from w h = 2 on it explodes. If shapes can touch (`touching`), a resting body must not fall far into
/// another within a substep.
SubstepPlan plan_substeps(const Scene& scene, const Realtime& accuracy, bool touching);

}  // namespace plumb
