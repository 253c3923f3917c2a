#pragma once

namespace plumb {

/// How often this program has called operator new so far.
long allocations();

}  // namespace plumb
