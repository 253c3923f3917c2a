#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace plumb::harness {

/// Outcome of work in a process of its own.
struct Outcome {
  enum class Kind {
    Done,         ///< `text` is the returned value
    Failed,       ///< it threw; `text` is the message
    Crashed,      ///< it died; `text` names the signal or the exit code, and its last output
    Timeout,      ///< it was stopped at the time limit; `text` says so
    Interrupted,  ///< it was stopped because the user asked
  };
  Kind kind = Kind::Done;
  std::string text;
  double seconds = 0;      ///< wall time
  std::size_t memory = 0;  ///< peak in bytes, of the process or of the largest child that it has waited for
};

/// Resource limits of a process.
struct ChildLimits {
  ChildLimits(double wall_seconds, std::size_t bytes = 0) : seconds(wall_seconds), memory(bytes) {}
  double seconds;
  std::size_t memory;  ///< bytes of address space of the process and each that it starts; 0: no limit
};

/// Runs `work` in a forked child, in its own process group, which is killed at the time limit or at an
/// interrupt. If the child was killed from outside, or its engine's program was, the work is not at fault and
/// is repeated, up to reference::kAttempts times. The child's output is discarded, except for the last lines
/// of a crash. Call this without threads running.
Outcome isolate(const std::function<std::string()>& work, const ChildLimits& limits);

/// Runs `work(0)` to `work(count - 1)`, at most `jobs` at a time, each as `isolate` does. Calls `done` in
/// this process once for each as it ends; after an interrupt the unfinished ones get `Interrupted`. If `done`
/// throws, the running children are killed.
void isolate_all(std::size_t count, int jobs, const std::function<ChildLimits(std::size_t)>& limits,
                 const std::function<std::string(std::size_t)>& work,
                 const std::function<void(std::size_t, const Outcome&)>& done);

/// Runs all of them with the same limits.
void isolate_all(std::size_t count, int jobs, const ChildLimits& limits,
                 const std::function<std::string(std::size_t)>& work,
                 const std::function<void(std::size_t, const Outcome&)>& done);

}  // namespace plumb::harness
