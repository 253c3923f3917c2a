#pragma once

#include "harness/thresholds/threshold.h"
#include "reference/backend.h"

namespace plumb::harness::thresholds {

/// Steps `trial` through `backend` to its end or until it breaks. A state that is not finite is a break.
/// Throws `Error` where the engine does.
Answer run_trial(const Trial& trial, const reference::Backend& backend,
                 const reference::StepSettings& settings);

/// The run of `threshold` at `value` in a process of its own, for at most `seconds`: an error, a crash and a
/// run without an end are breaks with their reason, and so is an engine that refuses the scene.
Answer run_isolated(const Threshold& threshold, double value, double resolution,
                    const reference::Backend& backend, const reference::StepSettings& settings,
                    double seconds);

}  // namespace plumb::harness::thresholds
