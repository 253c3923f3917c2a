#include "engine/math/vector_width.h"

#include <algorithm>
#include <atomic>

#include "engine/math/widest_register.h"

namespace plumb {
namespace {

VectorWidth find_widest() {
#if defined(__x86_64__) || defined(__i386__)
  if constexpr (kWidestRegister >= 32) {
    __builtin_cpu_init();
    if (__builtin_cpu_supports("avx2")) return VectorWidth::Bytes32;
  }
#if !defined(__SSE2__)
  return VectorWidth::None;
#endif
#endif
  return kWidestRegister >= 16 ? VectorWidth::Bytes16 : VectorWidth::None;
}

std::atomic<VectorWidth>& chosen() {
  static std::atomic<VectorWidth> width = widest_vectors();
  return width;
}

}  // namespace

VectorWidth widest_vectors() {
  static const VectorWidth widest = find_widest();
  return widest;
}

VectorWidth vector_width() { return chosen().load(std::memory_order_relaxed); }

void set_vector_width(VectorWidth width) {
  chosen().store(std::min(width, widest_vectors()), std::memory_order_relaxed);
}

}  // namespace plumb
