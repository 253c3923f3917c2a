#pragma once

namespace plumb::test {

/// How often this program has called operator new so far.
long allocations();

/// Bytes that operator new has given out and not got back, as the allocator rounded them.
long live_bytes();

}  // namespace plumb::test
