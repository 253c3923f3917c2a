#include "engine/core/mutex.h"

#ifndef PLUMB_NO_THREADS
#include "engine/core/thread_pool.h"

namespace plumb {
namespace {

// Number of polls before a thread yields the processor, and number of yields before it sleeps. A poll with
// its pause takes 10 to 40 ns, so these take about 20 us, longer than the time between two loops of a stage.
// A sleeping thread takes 5 to 50 us to wake.
constexpr int kSpins = 1000, kYields = 20;

}  // namespace

void wait_for_change(const std::atomic<int>& number, int old) {
  for (int i = 0; i < kSpins; ++i) {
    if (number.load(std::memory_order_acquire) != old) return;
    pause();
  }
  for (int i = 0; i < kYields; ++i) {
    if (number.load(std::memory_order_acquire) != old) return;
    std::this_thread::yield();
  }
  number.wait(old, std::memory_order_acquire);
}

ThreadPool::ThreadPool(int threads) {
  try {
    for (int i = 0; i < threads; ++i) threads_.emplace_back([this] { work(); });
  } catch (...) {
    stop();
    throw;
  }
}

ThreadPool::~ThreadPool() { stop(); }

void ThreadPool::stop() {
  ended_.store(true, std::memory_order_release);
  round_.fetch_add(1, std::memory_order_acq_rel);
  round_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

TaskSystem ThreadPool::tasks() {
  return {.start =
              [](void* pool, TaskSystem::Task task, void* data, int count) {
                static_cast<ThreadPool*>(pool)->start(task, data, count);
                return static_cast<void*>(nullptr);
              },
          .finish = [](void* pool, void*) { static_cast<ThreadPool*>(pool)->finish(); },
          .user = this};
}

void ThreadPool::start(TaskSystem::Task task, void* data, int count) {
  task_ = task, data_ = data, count_ = count;
  done_.store(0, std::memory_order_relaxed);
  range_.publish(0, static_cast<std::uint32_t>(count));
  round_.fetch_add(1, std::memory_order_acq_rel);
  round_.notify_all();
}

void ThreadPool::finish() {
  run_claimed();
  for (int done = done_.load(std::memory_order_acquire); done != count_;
       done = done_.load(std::memory_order_acquire)) {
    wait_for_change(done_, done);
  }
}

void ThreadPool::run_claimed() {
  for (int item = range_.claim(); item >= 0; item = range_.claim()) {
    task_(data_, item);
    done_.fetch_add(1, std::memory_order_acq_rel);
    done_.notify_all();
  }
}

void ThreadPool::work() {
  for (int seen = 0;;) {
    wait_for_change(round_, seen);
    seen = round_.load(std::memory_order_acquire);
    if (ended_.load(std::memory_order_acquire)) return;
    run_claimed();
  }
}

}  // namespace plumb
#endif
