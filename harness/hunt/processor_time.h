#pragma once

namespace plumb::harness::hunt {

/// Returns the processor time of this process so far, s; it does not depend on the machine's load.
double processor_seconds();

}  // namespace plumb::harness::hunt
