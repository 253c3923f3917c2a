#pragma once

#include <algorithm>
#include <memory>
#include <type_traits>

#include "engine/core/task_system.h"

namespace plumb {

/// Order in which a loop's blocks are begun. Every order gives the same bits; only tests change it.
enum class LoopOrder { Ascending, Descending, Shuffled };

/// Runs the loops of a world's step in parallel (parallel for): on the calling thread, and on those of the
/// world's own pool or of a game's task system. A loop is divided into blocks that do not depend on the
/// number of threads. A block writes only data that no other block of the loop reads or writes;
/// order-dependent results are collected block by block (block_lists.h). Loops run within sessions. A
/// session's body runs once, on the first thread to arrive, and the others take part in its loops. So no
/// thread waits for one that does not arrive, whatever the task system does. The body must not call user
/// code, which must run on the calling thread.
class LoopScheduler {
 public:
  static constexpr int kMaxThreads = 64;

  LoopScheduler();
  ~LoopScheduler();
  LoopScheduler(const LoopScheduler&) = delete;
  LoopScheduler& operator=(const LoopScheduler&) = delete;

  /// Sets the number of threads, 1 to kMaxThreads, and starts a pool. Throws std::system_error if the system
  /// has no more threads, and then changes nothing.
  void set_threads(int threads);
  int threads() const { return threads_; }
  /// Uses a game's threads in place of the pool; an empty task system restores the pool, which throws as
  /// `set_threads` does.
  void set_tasks(const TaskSystem& tasks);
  void set_order(LoopOrder order) { order_ = order; }
  /// Sets whether all loops are shared, however small: for tests.
  void set_eager(bool eager) { eager_ = eager; }

  /// Sets whether the work of the next sessions is worth several threads.
  void set_busy(bool busy) { busy_ = busy; }
  /// Returns true if loops are shared now.
  bool shares() const { return (busy_ || eager_) && threads_ > 1 && !serial_; }

  /// Runs all loops on the calling thread while this guard is alive, if `wanted`.
  class SerialGuard {
   public:
    SerialGuard(LoopScheduler& scheduler, bool wanted) : scheduler_(scheduler), before_(scheduler.serial_) {
      scheduler.serial_ = before_ || wanted;
    }
    ~SerialGuard() { scheduler_.serial_ = before_; }
    SerialGuard(const SerialGuard&) = delete;
    SerialGuard& operator=(const SerialGuard&) = delete;

   private:
    LoopScheduler& scheduler_;
    bool before_;
  };

  /// Runs `body()` once; loops in it are shared. Rethrows its exceptions. A nested session is part of the
  /// outer one.
  template <class Body>
  void session(Body&& body) {
    if (!shares() || in_session()) return body();
    run_session([](void* b) { (*static_cast<std::remove_reference_t<Body>*>(b))(); }, address(body));
  }

  /// Calls `run(block)` for each block from 0 to count - 1, and returns after all have ended. If some throw,
  /// the others still run, and the exception of the first of them is rethrown. Opens a session if there is
  /// none.
  template <class Run>
  void blocks(int count, Run&& run) {
    if (count <= 0) return;
    if (count == 1) return run(0);
    if (!shares()) return run_serial(count, run);
    session([&] {
      run_shared(
          count, [](void* r, int block) { (*static_cast<std::remove_reference_t<Run>*>(r))(block); },
          address(run));
    });
  }

  /// Calls `run(first, last)` for ranges of `grain` of `count` items, the last one shorter.
  template <class Run>
  void ranges(int count, int grain, Run&& run) {
    if (count <= grain || (!shares() && order_ == LoopOrder::Ascending)) {
      if (count > 0) run(0, count);
      return;
    }
    blocks((count + grain - 1) / grain,
           [&](int block) { run(block * grain, std::min(count, (block + 1) * grain)); });
  }

 private:
  struct Shared;
  template <class T>
  static void* address(T& it) {
    return const_cast<void*>(static_cast<const void*>(std::addressof(it)));
  }
  template <class Run>
  void run_serial(int count, Run& run) {
    for (int i = 0; i < count; ++i) run(order_ == LoopOrder::Ascending ? i : block_at(i, count));
  }
  void restart(int threads, const TaskSystem& tasks);
  /// Returns the block that comes at `nth` place of `count` in the order of the loop.
  int block_at(int nth, int count) const;
  bool in_session() const;
  void run_session(void (*body)(void*), void* data);
  void run_shared(int count, void (*run)(void*, int), void* data);

  int threads_ = 1;
  bool busy_ = false, eager_ = kUsualThreads > 1, serial_ = false;
  LoopOrder order_ = LoopOrder::Ascending;
  TaskSystem tasks_;                ///< a game's
  std::unique_ptr<Shared> shared_;  ///< null with one thread
};

}  // namespace plumb
