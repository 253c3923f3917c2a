#pragma once

#include <cstddef>
#include <memory_resource>

#include "engine/core/mutex.h"

namespace plumb {

/// Memory pool that several threads may use at once. It keeps all memory that it gets from the system, so
/// blocks of a size that was used before cost no system allocation, whichever thread requests them.
class LockedPool final : public std::pmr::memory_resource {
 public:
  explicit LockedPool(const std::pmr::pool_options& options) : pool_(options) {}

 private:
  void* do_allocate(std::size_t bytes, std::size_t alignment) override {
    const MutexLock lock(mutex_);
    return pool_.allocate(bytes, alignment);
  }
  void do_deallocate(void* memory, std::size_t bytes, std::size_t alignment) override {
    const MutexLock lock(mutex_);
    pool_.deallocate(memory, bytes, alignment);
  }
  bool do_is_equal(const std::pmr::memory_resource& other) const noexcept override { return this == &other; }

  Mutex mutex_;
  std::pmr::unsynchronized_pool_resource pool_;
};

}  // namespace plumb
