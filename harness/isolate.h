#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace plumb::harness {

/// How work in a process of its own ended.
struct Outcome {
  enum class Kind {
    Done,         ///< `text` is what it returned
    Failed,       ///< it threw; `text` is the message
    Crashed,      ///< it died; `text` names the signal or the exit code, and the last words
    Timeout,      ///< it was stopped after its time; `text` says so
    Interrupted,  ///< it was stopped because the user asked
  };
  Kind kind = Kind::Done;
  std::string text;
  double seconds = 0;      ///< wall time
  std::size_t memory = 0;  ///< bytes, at the peak, of the process or of the largest that it has waited for
};

/// What a process may take.
struct ChildLimits {
  ChildLimits(double wall_seconds, std::size_t bytes = 0) : seconds(wall_seconds), memory(bytes) {}
  double seconds;
  std::size_t memory;  ///< bytes of address space, of the process and of each that it starts; 0: any
};

/// Runs `work` in a forked child, in a process group of its own that is killed when its time is over or
/// when an interrupt comes. What it prints goes nowhere but to the last words of a crash. Call without
/// threads running.
Outcome isolate(const std::function<std::string()>& work, const ChildLimits& limits);

/// `work(0)` to `work(count - 1)`, at most `jobs` at a time, each as `isolate` runs it. `done` is called in
/// this process as they end, once for each; after an interrupt with `Interrupted` for those that have not
/// ended. Where `done` throws, the children that are at work are killed.
void isolate_all(std::size_t count, int jobs, const std::function<ChildLimits(std::size_t)>& limits,
                 const std::function<std::string(std::size_t)>& work,
                 const std::function<void(std::size_t, const Outcome&)>& done);

/// The same limits for all.
void isolate_all(std::size_t count, int jobs, const ChildLimits& limits,
                 const std::function<std::string(std::size_t)>& work,
                 const std::function<void(std::size_t, const Outcome&)>& done);

}  // namespace plumb::harness
