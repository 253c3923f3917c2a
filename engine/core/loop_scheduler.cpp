#include "engine/core/loop_scheduler.h"

#include <numeric>
#include <system_error>
#include <utility>

#include "engine/core/mutex.h"

#ifndef PLUMB_NO_THREADS
#include <atomic>
#include <cfenv>
#include <exception>
#include <optional>
#include <thread>

#include "engine/core/thread_pool.h"
#endif

namespace plumb {

int LoopScheduler::block_at(int nth, int count) const {
  switch (order_) {
    case LoopOrder::Ascending:
      return nth;
    case LoopOrder::Descending:
      return count - 1 - nth;
    case LoopOrder::Shuffled:
      break;
  }
  // A stride that has no common factor with the count reaches each block once.
  long long stride = std::max(1, count * 5 / 8);
  while (std::gcd(stride, static_cast<long long>(count)) != 1) ++stride;
  return static_cast<int>((stride * nth + count / 3) % count);
}

void LoopScheduler::set_threads(int threads) {
  if (threads != threads_) restart(threads, tasks_);
}

void LoopScheduler::set_tasks(const TaskSystem& tasks) { restart(threads_, tasks); }

#ifdef PLUMB_NO_THREADS

// Without thread support, one thread runs all loops, without sessions.
struct LoopScheduler::Shared {};

void LoopScheduler::restart(int threads, const TaskSystem& tasks) {
  if (threads > 1) throw std::system_error(std::make_error_code(std::errc::resource_unavailable_try_again));
  tasks_ = tasks;
}
bool LoopScheduler::in_session() const { return false; }
void LoopScheduler::run_session(void (*body)(void*), void* data) { body(data); }
void LoopScheduler::run_shared(int count, void (*run)(void*, int), void* data) {
  for (int i = 0; i < count; ++i) run(data, block_at(i, count));
}

#else

namespace {

// Gives this thread the floating-point environment (rounding mode, treatment of denormals) of another thread
// while the guard is alive.
class FenvGuard {
 public:
  explicit FenvGuard(const std::fenv_t& as) {
    std::fegetenv(&previous_);
    std::fesetenv(&as);
  }
  ~FenvGuard() { std::fesetenv(&previous_); }
  FenvGuard(const FenvGuard&) = delete;
  FenvGuard& operator=(const FenvGuard&) = delete;

 private:
  std::fenv_t previous_;
};

// Number of polls before a thread that waits for another thread's last block yields the processor: about 10
// us, longer than nearly all blocks take.
constexpr int kMaxSpins = 500;

}  // namespace

struct LoopScheduler::Shared {
  /// Blocks that a thread claims first, so that later loops find their data in its cache. After them it
  /// claims blocks of other threads. One cache line per thread.
  struct alignas(64) ThreadBlocks {
    AtomicBlockRange range;
  };

  explicit Shared(int threads) : thread_blocks(std::make_unique<ThreadBlocks[]>(threads)), count(threads) {}

  // Runs blocks of the loop until all are claimed, first those of the thread `own`.
  void run_claimed(int own) {
    int finished = 0;
    for (int i = 0; i < count; ++i) {
      AtomicBlockRange& range = thread_blocks[(own + i) % count].range;
      for (int block = range.claim(); block >= 0; block = range.claim()) {
        run_block(block);
        ++finished;
      }
    }
    if (finished > 0) done.fetch_add(finished, std::memory_order_acq_rel);
  }

  void run_block(int block) {
    try {
      run(data, scheduler->block_at(block, blocks));
    } catch (...) {
      const MutexLock lock(failure_mutex);
      const int index = scheduler->block_at(block, blocks);
      if (failure != nullptr && failed_block < index) return;
      failure = std::current_exception();
      failed_block = index;
    }
  }

  // The task of another thread.
  void join_with_callers_fenv(int own) {
    const FenvGuard guard(environment);
    join(own);
  }

  // Runs the session if this is the first thread to arrive; otherwise takes part in its loops.
  void join(int own) {
    if (!has_leader.exchange(true, std::memory_order_acq_rel)) {
      leader = own;
      try {
        body(body_data);
      } catch (...) {
        body_failure = std::current_exception();
      }
      ended.store(true, std::memory_order_release);
      next_loop();
      return;
    }
    for (;;) {
      const int seen = loop.load(std::memory_order_acquire);
      run_claimed(own);
      if (ended.load(std::memory_order_acquire)) return;
      wait_for_change(loop, seen);
    }
  }

  void next_loop() {
    loop.fetch_add(1, std::memory_order_acq_rel);
    loop.notify_all();
  }

  const LoopScheduler* scheduler = nullptr;
  std::unique_ptr<ThreadBlocks[]> thread_blocks;
  int count;  ///< of threads
  std::optional<ThreadPool> pool;
  TaskSystem tasks;

  // The session.
  bool open = false;
  void (*body)(void*) = nullptr;
  void* body_data = nullptr;
  std::exception_ptr body_failure;
  std::fenv_t environment{};  ///< the environment in which the calling thread computes
  int leader = 0;
  std::atomic<bool> has_leader{false}, ended{false};
  alignas(64) std::atomic<int> loop{0};  ///< changes with each loop, and at the end

  // The loop, valid while a block of it is claimed.
  void (*run)(void*, int) = nullptr;
  void* data = nullptr;
  int blocks = 0;
  Mutex failure_mutex;
  std::exception_ptr failure;
  int failed_block = 0;
  alignas(64) std::atomic<int> done{0};  ///< blocks
};

void LoopScheduler::restart(int threads, const TaskSystem& tasks) {
  std::unique_ptr<Shared> shared;
  if (threads > 1) {
    shared = std::make_unique<Shared>(threads);
    shared->scheduler = this, shared->tasks = tasks;
    if (tasks.start == nullptr) {
      shared->pool.emplace(threads - 1);
      shared->tasks = shared->pool->tasks();
    }
  }
  shared_ = std::move(shared);
  threads_ = threads, tasks_ = tasks;
}

bool LoopScheduler::in_session() const { return shared_ != nullptr && shared_->open; }

void LoopScheduler::run_session(void (*body)(void*), void* data) {
  Shared& s = *shared_;
  s.body = body, s.body_data = data, s.body_failure = nullptr;
  s.has_leader.store(false, std::memory_order_relaxed), s.ended.store(false, std::memory_order_relaxed);
  std::fegetenv(&s.environment);
  s.open = true;
  void* const started = s.tasks.start(
      s.tasks.user, [](void* all, int item) { static_cast<Shared*>(all)->join_with_callers_fenv(item + 1); },
      &s, threads_ - 1);
  s.join(0);
  s.tasks.finish(s.tasks.user, started);
  s.open = false;
  if (s.body_failure != nullptr) std::rethrow_exception(std::exchange(s.body_failure, nullptr));
}

void LoopScheduler::run_shared(int count, void (*run)(void*, int), void* data) {
  Shared& s = *shared_;
  s.run = run, s.data = data, s.blocks = count;
  s.done.store(0, std::memory_order_relaxed);
  for (int i = 0; i < threads_; ++i) {
    const auto bound = [&](int thread) {
      return static_cast<std::uint32_t>(static_cast<long long>(count) * thread / threads_);
    };
    s.thread_blocks[i].range.publish(bound(i), bound(i + 1));
  }
  s.next_loop();
  s.run_claimed(s.leader);
  for (int spins = 0; s.done.load(std::memory_order_acquire) != count; ++spins) {
    if (spins < kMaxSpins) {
      pause();
    } else {
      std::this_thread::yield();
    }
  }
  if (s.failure != nullptr) std::rethrow_exception(std::exchange(s.failure, nullptr));
}

#endif

LoopScheduler::LoopScheduler() = default;
LoopScheduler::~LoopScheduler() = default;

}  // namespace plumb
