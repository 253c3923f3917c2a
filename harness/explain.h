#pragma once

#include <string>

#include "engine/scene/scene.h"
#include "engine/simulation/accuracy.h"
#include "engine/simulation/plan.h"
#include "harness/style.h"
#include "reference/backend.h"

namespace plumb::harness {

/// What plumb does for a scene, why, and what share of a step each stage takes.
struct Explanation {
  std::string scene;
  std::string engine;
  reference::Settings settings;
  Plan plan;               ///< with the time spent in each stage
  int steps = 0;           ///< that were run to measure
  double nanoseconds = 0;  ///< all stages together
  double ns_per_step = 0;  ///< wall time without the stages' clocks
};

/// The accuracy that `backend`, one of plumb's own, stands for. Throws `Error` (Unsupported) for another
/// engine: plans exist only here.
Accuracy accuracy_of(const reference::Backend& backend, const reference::StepSettings& settings);

/// Compiles `scene` and runs it for `duration` s, but for no more than about a second of wall time, with the
/// stages' clocks on. Throws `Error`.
Explanation explain(const Scene& scene, const reference::Backend& backend,
                    const reference::StepSettings& settings, double duration);

std::string to_console(const Explanation& explanation, const Style& style);
std::string to_json(const Explanation& explanation);

}  // namespace plumb::harness
