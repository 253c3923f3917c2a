#pragma once

#include <cstdint>

namespace plumb::field::heap {

/// Returns true if this build counts. Builds with sanitizers do not, because those have an allocator of their
/// own.
bool counted();

/// Returns the calls of malloc, calloc, realloc, aligned allocation and operator new in the whole program so
/// far.
std::int64_t allocations();

/// Returns the bytes allocated now, as rounded by the allocator.
std::int64_t live_bytes();

}  // namespace plumb::field::heap
