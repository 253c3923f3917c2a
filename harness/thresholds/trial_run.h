#pragma once

#include "harness/thresholds/threshold.h"
#include "reference/backend.h"

namespace plumb::harness::thresholds {

/// Steps `trial` through `backend` to its end or until it breaks. A non-finite state is a break. Throws
/// `Error` if the engine does.
Answer run_trial(const Trial& trial, const reference::Backend& backend,
                 const reference::StepSettings& settings);

/// Runs `threshold` at `value` in a process of its own, for at most `seconds`. An error, a crash, a timeout
/// and a refusal by the engine are breaks with their reason.
Answer run_isolated(const Threshold& threshold, double value, double resolution,
                    const reference::Backend& backend, const reference::StepSettings& settings,
                    double seconds);

}  // namespace plumb::harness::thresholds
