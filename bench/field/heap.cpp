// Counts allocations by interposing glibc's allocator. Shared libraries use these functions as well, because
// the program's own symbols come first.
#include "bench/field/heap.h"

#include <cerrno>
#include <cstddef>
#include <cstdlib>

#include <malloc.h>

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || !defined(__GLIBC__)
#define PLUMB_FIELD_COUNTS_HEAP 0
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define PLUMB_FIELD_COUNTS_HEAP 0
#else
#define PLUMB_FIELD_COUNTS_HEAP 1
#endif
#else
#define PLUMB_FIELD_COUNTS_HEAP 1
#endif

namespace plumb::field::heap {
namespace {

// One relaxed addition per call: exact from any thread, and cheap beside the allocation.
std::int64_t allocation_count = 0;
std::int64_t byte_count = 0;

}  // namespace

bool counted() { return PLUMB_FIELD_COUNTS_HEAP != 0; }
std::int64_t allocations() { return __atomic_load_n(&allocation_count, __ATOMIC_RELAXED); }
std::int64_t live_bytes() { return __atomic_load_n(&byte_count, __ATOMIC_RELAXED); }

#if PLUMB_FIELD_COUNTS_HEAP
static void* gained(void* block) {
  if (block == nullptr) return block;
  __atomic_add_fetch(&allocation_count, 1, __ATOMIC_RELAXED);
  __atomic_add_fetch(&byte_count, static_cast<std::int64_t>(malloc_usable_size(block)), __ATOMIC_RELAXED);
  return block;
}

static void lost(void* block) {
  if (block == nullptr) return;
  __atomic_sub_fetch(&byte_count, static_cast<std::int64_t>(malloc_usable_size(block)), __ATOMIC_RELAXED);
}
#endif

}  // namespace plumb::field::heap

#if PLUMB_FIELD_COUNTS_HEAP
extern "C" {

void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);
void __libc_free(void*);

void* malloc(std::size_t size) { return plumb::field::heap::gained(__libc_malloc(size)); }
void* calloc(std::size_t count, std::size_t size) {
  return plumb::field::heap::gained(__libc_calloc(count, size));
}
void free(void* block) {
  plumb::field::heap::lost(block);
  __libc_free(block);
}
void* realloc(void* block, std::size_t size) {
  const std::size_t before = block == nullptr ? 0 : malloc_usable_size(block);
  void* out = __libc_realloc(block, size);
  if (out == nullptr && size != 0) return out;  // the old block is unchanged
  __atomic_sub_fetch(&plumb::field::heap::byte_count, static_cast<std::int64_t>(before), __ATOMIC_RELAXED);
  return plumb::field::heap::gained(out);
}
void* memalign(std::size_t alignment, std::size_t size) {
  return plumb::field::heap::gained(__libc_memalign(alignment, size));
}
void* aligned_alloc(std::size_t alignment, std::size_t size) { return memalign(alignment, size); }
int posix_memalign(void** out, std::size_t alignment, std::size_t size) {
  if (alignment < sizeof(void*) || (alignment & (alignment - 1)) != 0) return EINVAL;
  void* block = memalign(alignment, size);
  if (block == nullptr) return ENOMEM;
  *out = block;
  return 0;
}
}
#endif
