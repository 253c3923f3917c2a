#pragma once

#include <functional>
#include <string>

#include "harness/isolate.h"

namespace plumb::harness::hunt {

/// Wall time over processor time after which work counts as stuck: machines are shared.
inline constexpr double kPatience = 20;

/// Returns the processor time of this process so far, s; it does not depend on the machine's load.
double processor_seconds();

/// Runs `work` in a process of its own (`isolate`), which is stopped after `seconds` of processor time, or
/// kPatience times that of wall time.
Outcome isolate_within(double seconds, const std::function<std::string()>& work);

}  // namespace plumb::harness::hunt
