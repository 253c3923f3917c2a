#include "engine/core/crew.h"

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

int Crew::place(int nth, int count) const {
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

void Crew::set_threads(int threads) {
  if (threads != threads_) renew(threads, tasks_);
}

void Crew::set_tasks(const TaskSystem& tasks) { renew(threads_, tasks); }

#ifdef PLUMB_NO_THREADS

// Without thread support, one thread runs all loops, without sessions.
struct Crew::Shared {};

void Crew::renew(int threads, const TaskSystem& tasks) {
  if (threads > 1) throw std::system_error(std::make_error_code(std::errc::resource_unavailable_try_again));
  tasks_ = tasks;
}
bool Crew::in_session() const { return false; }
void Crew::open(void (*body)(void*), void* data) { body(data); }
void Crew::share(int count, void (*run)(void*, int), void* data) {
  for (int i = 0; i < count; ++i) run(data, place(i, count));
}

#else

namespace {

// While this guard is alive, the thread has the floating-point environment of another thread: rounding mode
// and treatment of denormals.
class Computing {
 public:
  explicit Computing(const std::fenv_t& as) {
    std::fegetenv(&own_);
    std::fesetenv(&as);
  }
  ~Computing() { std::fesetenv(&own_); }
  Computing(const Computing&) = delete;
  Computing& operator=(const Computing&) = delete;

 private:
  std::fenv_t own_;
};

// Number of polls before a thread that waits for another thread's last block yields the processor: about 10
// us, longer than nearly all blocks take.
constexpr int kLooksAtLast = 500;

}  // namespace

struct Crew::Shared {
  /// The blocks that a thread claims first, so that a later loop finds their data in its cache; after them it
  /// claims blocks of other threads. One cache line each.
  struct alignas(64) Share {
    Claims claims;
  };

  explicit Shared(int threads) : shares(std::make_unique<Share[]>(threads)), count(threads) {}

  // Runs blocks of the loop until all are claimed.
  void take_part(int own) {
    int finished = 0;
    for (int i = 0; i < count; ++i) {
      Claims& claims = shares[(own + i) % count].claims;
      for (int block = claims.claim(); block >= 0; block = claims.claim()) {
        run_block(block);
        ++finished;
      }
    }
    if (finished > 0) done.fetch_add(finished, std::memory_order_acq_rel);
  }

  void run_block(int block) {
    try {
      run(data, crew->place(block, blocks));
    } catch (...) {
      const MutexLock lock(failing);
      const int place = crew->place(block, blocks);
      if (failure != nullptr && failed_block < place) return;
      failure = std::current_exception();
      failed_block = place;
    }
  }

  // The task of another thread.
  void join_as_caller_computes(int own) {
    const Computing computing(environment);
    join(own);
  }

  // Runs the session if this is the first thread to arrive; otherwise takes part in its loops.
  void join(int own) {
    if (!led.exchange(true, std::memory_order_acq_rel)) {
      leader = own;
      try {
        body(body_data);
      } catch (...) {
        body_failure = std::current_exception();
      }
      closed.store(true, std::memory_order_release);
      next_loop();
      return;
    }
    for (;;) {
      const int seen = loop.load(std::memory_order_acquire);
      take_part(own);
      if (closed.load(std::memory_order_acquire)) return;
      wait_for_change(loop, seen);
    }
  }

  void next_loop() {
    loop.fetch_add(1, std::memory_order_acq_rel);
    loop.notify_all();
  }

  const Crew* crew = nullptr;
  std::unique_ptr<Share[]> shares;
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
  std::atomic<bool> led{false}, closed{false};
  alignas(64) std::atomic<int> loop{0};  ///< changes with each loop, and at the end

  // The loop, valid while a block of it is claimed.
  void (*run)(void*, int) = nullptr;
  void* data = nullptr;
  int blocks = 0;
  Mutex failing;
  std::exception_ptr failure;
  int failed_block = 0;
  alignas(64) std::atomic<int> done{0};  ///< blocks
};

void Crew::renew(int threads, const TaskSystem& tasks) {
  std::unique_ptr<Shared> shared;
  if (threads > 1) {
    shared = std::make_unique<Shared>(threads);
    shared->crew = this, shared->tasks = tasks;
    if (tasks.start == nullptr) {
      shared->pool.emplace(threads - 1);
      shared->tasks = shared->pool->tasks();
    }
  }
  shared_ = std::move(shared);
  threads_ = threads, tasks_ = tasks;
}

bool Crew::in_session() const { return shared_ != nullptr && shared_->open; }

void Crew::open(void (*body)(void*), void* data) {
  Shared& s = *shared_;
  s.body = body, s.body_data = data, s.body_failure = nullptr;
  s.led.store(false, std::memory_order_relaxed), s.closed.store(false, std::memory_order_relaxed);
  std::fegetenv(&s.environment);
  s.open = true;
  void* const started = s.tasks.start(
      s.tasks.user, [](void* all, int item) { static_cast<Shared*>(all)->join_as_caller_computes(item + 1); },
      &s, threads_ - 1);
  s.join(0);
  s.tasks.finish(s.tasks.user, started);
  s.open = false;
  if (s.body_failure != nullptr) std::rethrow_exception(std::exchange(s.body_failure, nullptr));
}

void Crew::share(int count, void (*run)(void*, int), void* data) {
  Shared& s = *shared_;
  s.run = run, s.data = data, s.blocks = count;
  s.done.store(0, std::memory_order_relaxed);
  for (int i = 0; i < threads_; ++i) {
    const auto bound = [&](int share) {
      return static_cast<std::uint32_t>(static_cast<long long>(count) * share / threads_);
    };
    s.shares[i].claims.publish(bound(i), bound(i + 1));
  }
  s.next_loop();
  s.take_part(s.leader);
  for (int looks = 0; s.done.load(std::memory_order_acquire) != count; ++looks) {
    if (looks < kLooksAtLast) {
      pause();
    } else {
      std::this_thread::yield();
    }
  }
  if (s.failure != nullptr) std::rethrow_exception(std::exchange(s.failure, nullptr));
}

#endif

Crew::Crew() = default;
Crew::~Crew() = default;

}  // namespace plumb
