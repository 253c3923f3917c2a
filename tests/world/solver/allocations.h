#pragma once

namespace plumb {

/// Returns how often this program has called operator new so far.
long allocations();

}  // namespace plumb
