#pragma once

#include "harness/isolate.h"
#include "harness/run.h"

namespace plumb::harness {

/// A run, and what it takes to go on with it.
struct IsolatedRun {
  Result result;
  double nanoseconds = 0;  ///< that the engine spent on the whole run
  bool interrupted = false;
};

/// `run` in a process of its own: an error, a crash or a hang becomes the result's status.
IsolatedRun run_isolated(const Case& scene_case, const reference::Backend& backend,
                         const reference::StepSettings& settings, Track* track, double seconds);

}  // namespace plumb::harness
