#include "tests/world/allocations.h"

#include <atomic>
#include <cstdlib>
#include <new>

#include <malloc.h>

namespace {

std::atomic<long> count{0}, bytes{0}, others{-1};
std::atomic<bool> failed{false};

void* counted(std::size_t size, std::size_t alignment) {
  ++count;
  if (others >= 0 && others-- == 0) {
    failed = true;
    throw std::bad_alloc();
  }
  const std::size_t room = (size + alignment - 1) / alignment * alignment;
  void* memory = std::aligned_alloc(alignment, room > 0 ? room : alignment);
  if (memory == nullptr) throw std::bad_alloc();
  bytes += static_cast<long>(malloc_usable_size(memory));
  return memory;
}

void give_back(void* memory) {
  if (memory != nullptr) bytes -= static_cast<long>(malloc_usable_size(memory));
  std::free(memory);
}

constexpr std::size_t kUsual = __STDCPP_DEFAULT_NEW_ALIGNMENT__;

}  // namespace

namespace plumb::test {

long allocations() { return count; }
long live_bytes() { return bytes; }
void fail_after(long more) {
  failed = false;
  others = more;
}
bool has_failed() { return failed; }

}  // namespace plumb::test

// All forms stand here and are not inlined, such that the compiler sees pairs that match.
[[gnu::noinline]] void* operator new(std::size_t size) { return counted(size, kUsual); }
[[gnu::noinline]] void* operator new[](std::size_t size) { return counted(size, kUsual); }
[[gnu::noinline]] void* operator new(std::size_t size, std::align_val_t alignment) {
  return counted(size, static_cast<std::size_t>(alignment));
}
[[gnu::noinline]] void* operator new[](std::size_t size, std::align_val_t alignment) {
  return counted(size, static_cast<std::size_t>(alignment));
}
[[gnu::noinline]] void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  try {
    return counted(size, kUsual);
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { give_back(memory); }
[[gnu::noinline]] void operator delete[](void* memory) noexcept { give_back(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { give_back(memory); }
[[gnu::noinline]] void operator delete[](void* memory, std::size_t) noexcept { give_back(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::align_val_t) noexcept { give_back(memory); }
[[gnu::noinline]] void operator delete[](void* memory, std::align_val_t) noexcept { give_back(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  give_back(memory);
}
[[gnu::noinline]] void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept {
  give_back(memory);
}
