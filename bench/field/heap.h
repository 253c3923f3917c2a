#pragma once

#include <cstdint>

namespace plumb::field::heap {

/// Whether this build counts: not under the sanitizers, which have an allocator of their own.
bool counted();

/// Calls of malloc, calloc, realloc, aligned allocation and operator new of the whole program, so far.
std::int64_t allocations();

/// Bytes that are allocated now, as the allocator rounded them.
std::int64_t live_bytes();

}  // namespace plumb::field::heap
