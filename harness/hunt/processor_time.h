#pragma once

namespace plumb::harness::hunt {

/// Returns the processor time of this process so far, s: a busy machine does not stretch it.
double processor_seconds();

}  // namespace plumb::harness::hunt
