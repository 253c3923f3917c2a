#pragma once

#include <string>

#include "engine/scene/scene.h"
#include "engine/simulation/accuracy.h"

namespace plumb {

/// Into how many equal substeps a step is divided, and why.
struct SubstepPlan {
  double count = 1;  ///< a whole number; more than kMostNeeded are refused, unless asked for
  std::string why{};
};

/// Most substeps of a step, asked for; and needed: a step of more is no step any more.
inline constexpr int kMostSubsteps = 1000000, kMostNeeded = 100000;

/// What was asked for, or more where velocity Verlet would not follow what is known of the scene before it
/// moves: the frequency w of its springs, of its pendulums, and of light links between which a heavy load
/// hangs. Its error is (w h)^2/4 of a mode's energy, and from w h = 2 on it explodes. Where shapes can touch
/// (`touching`), what rests must not fall far into the other before the next substep holds it.
SubstepPlan plan_substeps(const Scene& scene, const Realtime& accuracy, bool touching);

}  // namespace plumb
