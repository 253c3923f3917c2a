#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "engine/core/task_system.h"
#include "engine/world/world.h"
#include "engine/world/world_data.h"

namespace plumb::test {

/// Job systems of games, which run their tasks as a world does not expect it.
class OddTasks {
 public:
  enum Kind { BackwardsAtOnce, BackwardsAtTheEnd, OneAfterTheOtherElsewhere, AllElsewhere };
  explicit OddTasks(Kind kind) : kind_(kind) {}

  TaskSystem system() {
    return {.start =
                [](void* self, TaskSystem::Task task, void* data, int count) {
                  static_cast<OddTasks*>(self)->start(task, data, count);
                  return self;
                },
            .finish =
                [](void* self, void* started) {
                  EXPECT_EQ(started, self);
                  static_cast<OddTasks*>(self)->finish();
                },
            .user = this};
  }

  int rounds = 0, tasks = 0;

 private:
  void start(TaskSystem::Task task, void* data, int count) {
    ++rounds, tasks += count;
    const auto run = [=] {
      for (int i = count - 1; i >= 0; --i) task(data, i);
    };
    switch (kind_) {
      case BackwardsAtOnce:
        return run();
      case BackwardsAtTheEnd:
        left_ = run;
        return;
      case OneAfterTheOtherElsewhere:
        for (int i = count - 1; i >= 0; --i) std::thread(task, data, i).join();
        return;
      case AllElsewhere:
        for (int i = count - 1; i >= 0; --i) threads_.emplace_back(task, data, i);
    }
  }
  void finish() {
    if (left_) left_();
    left_ = nullptr;
    for (std::thread& thread : threads_) thread.join();
    threads_.clear();
  }

  Kind kind_;
  std::function<void()> left_;
  std::vector<std::thread> threads_;
};

/// Shares all loops of a world, however small.
template <class Real>
void share_all(BasicWorld<Real>& world, int threads, LoopOrder order = LoopOrder::Ascending) {
  world.set_threads(threads);
  world.data().scheduler.set_eager(true);
  world.data().scheduler.set_order(order);
}

/// True under the thread sanitizer, where a step takes a hundred times as long and a race shows in any order.
#ifdef __SANITIZE_THREAD__
inline constexpr bool kThreadSanitizer = true;
#else
inline constexpr bool kThreadSanitizer = false;
#endif

/// Calls `act(thread)` for numbers of threads, orders of blocks and job systems of all kinds; `thread(world)`
/// sets up a world so.
template <class Real, class Act>
void at_each_threading(Act&& act) {
  using Set = std::function<void(BasicWorld<Real>&)>;
  for (const int threads : {1, 2, 3, 8}) {
    for (const LoopOrder order : {LoopOrder::Ascending, LoopOrder::Descending, LoopOrder::Shuffled}) {
      if (kThreadSanitizer && (threads != 2 || order != LoopOrder::Shuffled)) continue;
      SCOPED_TRACE(std::to_string(threads) + " threads, order " + std::to_string(static_cast<int>(order)));
      act(Set([&](BasicWorld<Real>& world) { share_all(world, threads, order); }));
    }
  }
  for (const auto kind : {OddTasks::BackwardsAtOnce, OddTasks::BackwardsAtTheEnd,
                          OddTasks::OneAfterTheOtherElsewhere, OddTasks::AllElsewhere}) {
    if (kThreadSanitizer && kind != OddTasks::AllElsewhere) continue;
    SCOPED_TRACE("job system " + std::to_string(static_cast<int>(kind)));
    OddTasks tasks(kind);
    act(Set([&](BasicWorld<Real>& world) {
      share_all(world, 3);
      world.set_task_system(tasks.system());
    }));
    EXPECT_GT(tasks.rounds, 0);
  }
}

}  // namespace plumb::test
