#pragma once

#include <atomic>
#include <cstdint>
#include <thread>
#include <vector>

#include "engine/core/task_system.h"

namespace plumb {

/// Range of a loop's blocks, which several threads claim one by one. Stored in one word: the end in the upper
/// half, the next block in the lower. A successful claim belongs to the loop that is published at that
/// moment, so a late thread needs no knowledge of earlier loops.
class AtomicBlockRange {
 public:
  void publish(std::uint32_t first, std::uint32_t end) {
    word_.store(std::uint64_t{end} << 32 | first, std::memory_order_release);
  }
  /// Returns a block that no other thread gets, or -1.
  int claim() {
    if (!any(word_.load(std::memory_order_acquire))) return -1;
    const std::uint64_t word = word_.fetch_add(1, std::memory_order_acq_rel);
    return any(word) ? static_cast<int>(word & 0xFFFFFFFFu) : -1;
  }

 private:
  static bool any(std::uint64_t word) { return (word & 0xFFFFFFFFu) < word >> 32; }

  std::atomic<std::uint64_t> word_{0};
};

/// Tells a processor that this thread waits for another one.
inline void pause() {
#if defined(__x86_64__) || defined(__i386__)
  __builtin_ia32_pause();
#elif defined(__aarch64__)
  asm volatile("yield");
#endif
}

/// Waits until `number` is no longer `old`: first by polling, because most waits of a step last microseconds,
/// then asleep, because other programs need the processor too.
void wait_for_change(const std::atomic<int>& number, int old);

/// A few threads that run the tasks of one loop at a time, and sleep when there is none.
class ThreadPool {
 public:
  /// Starts the threads. Throws std::system_error if the system has no more threads.
  explicit ThreadPool(int threads);
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  /// Returns an interface to this pool, which it must not outlive. One loop at a time.
  TaskSystem tasks();

 private:
  void start(TaskSystem::Task task, void* data, int count);
  void finish();
  void work();
  void run_claimed();
  void stop();

  std::vector<std::thread> threads_;
  TaskSystem::Task task_ = nullptr;
  void* data_ = nullptr;
  int count_ = 0;
  AtomicBlockRange range_;
  std::atomic<int> done_{0};
  std::atomic<int> round_{0};  ///< changes with each loop
  std::atomic<bool> ended_{false};
};

}  // namespace plumb
