#pragma once

#include <string>

#include "engine/driver/accuracy.h"
#include "engine/driver/plan.h"
#include "engine/scene/scene.h"
#include "harness/style.h"
#include "reference/backend.h"

namespace plumb::harness {

/// Plan of plumb for a scene, its reasons, and each stage's fraction of a step.
struct Explanation {
  std::string scene;
  std::string engine;
  reference::Settings settings;
  Plan plan;               ///< with the time spent in each stage
  int steps = 0;           ///< steps that were run to measure
  double nanoseconds = 0;  ///< all stages together
  double ns_per_step = 0;  ///< wall time measured with the stages' clocks off
};

/// Returns the accuracy that `backend`, one of plumb's own, stands for. Throws `Error` (Unsupported) for
/// another engine, because only plumb has plans.
Accuracy accuracy_of(const reference::Backend& backend, const reference::StepSettings& settings);

/// Compiles `scene` and runs it with the stages' clocks on, for `duration` s or about a second of wall time,
/// whichever ends first. Throws `Error`.
Explanation explain(const Scene& scene, const reference::Backend& backend,
                    const reference::StepSettings& settings, double duration);

std::string to_console(const Explanation& explanation, const Style& style);
std::string to_json(const Explanation& explanation);

}  // namespace plumb::harness
