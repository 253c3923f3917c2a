#pragma once

namespace plumb::test {

/// Returns how often this program has called operator new so far.
long allocations();

/// Bytes that operator new has given out and not got back, as the allocator rounded them.
long live_bytes();

/// The allocation after `others` more of them fails once; a negative number: none does.
void fail_after(long others);
/// Returns true if it has.
bool has_failed();

}  // namespace plumb::test
