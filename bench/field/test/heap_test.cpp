#include "bench/field/heap.h"

#include <cstdlib>
#include <memory>
#include <new>

#include <gtest/gtest.h>

namespace plumb::field {
namespace {

/// Keeps the compiler from removing a pair of allocation and release.
void* seen(void* block) {
  asm volatile("" : "+r"(block) : : "memory");
  return block;
}

TEST(Heap, CountsWhatIsTakenAndGivenBack) {
  if (!heap::counted()) GTEST_SKIP() << "a sanitizer's allocator is in charge";
  const auto calls = heap::allocations(), bytes = heap::live_bytes();
  void* plain = seen(std::malloc(1000));
  void* zeroed = seen(std::calloc(10, 100));
  void* aligned = seen(std::aligned_alloc(64, 1024));
  auto* made = static_cast<int*>(seen(new int[250]));
  EXPECT_EQ(heap::allocations() - calls, 4);
  EXPECT_GE(heap::live_bytes() - bytes, 4024);
  EXPECT_LE(heap::live_bytes() - bytes, 4024 + 4 * 64);
  plain = seen(std::realloc(plain, 100000));
  EXPECT_EQ(heap::allocations() - calls, 5);
  EXPECT_GE(heap::live_bytes() - bytes, 103024);
  std::free(plain);
  std::free(zeroed);
  std::free(aligned);
  delete[] made;
  EXPECT_EQ(heap::live_bytes() - bytes, 0);
  EXPECT_EQ(heap::allocations() - calls, 5);
}

}  // namespace
}  // namespace plumb::field
