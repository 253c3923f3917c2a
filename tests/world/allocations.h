#pragma once

namespace plumb::test {

/// How often this program has called operator new so far.
long allocations();

}  // namespace plumb::test
