#pragma once

namespace plumb {

/// Default number of threads of a world. Test builds set another number (PLUMB_TEST_THREADS), and then share
/// all loops, however small.
#ifdef PLUMB_TEST_THREADS
inline constexpr int kUsualThreads = PLUMB_TEST_THREADS;
#else
inline constexpr int kUsualThreads = 1;
#endif

/// A game's job system, through which a world runs its parallel loops on the game's own threads. A plain
/// struct of function pointers, so that it can be filled from C too; both functions must be given, and must
/// not throw.
/// The world starts at most a few rounds of tasks a step, one or two for each large stage. All tasks of a
/// round are alike: they take part in the stage's work until it is done, and divide it among themselves. A
/// task that starts too late, or only in `finish`, therefore returns at once, and a task runs for up to the
/// time of the stage (some ms for ten thousand bodies). Neither the number of threads nor the order, time or
/// place of the tasks changes a bit of the result.
struct TaskSystem {
  /// A task: to be called once for each item from 0 to count - 1. It does not throw.
  using Task = void (*)(void* data, int item);

  /// Starts a parallel loop of `count` tasks, each a unit of its own (a grain of one). May run them at once,
  /// in any order, on any threads, or leave them to `finish`. Returns a handle for `finish`, which may be
  /// null. `user` is the member below.
  void* (*start)(void* user, Task task, void* data, int count) = nullptr;

  /// Returns after all tasks of a loop have returned; called once for each `start`, on the same thread. May
  /// run tasks that have not begun.
  void (*finish)(void* user, void* started) = nullptr;

  void* user = nullptr;  ///< passed on to both; must outlive the world, or its next task system
};

}  // namespace plumb
