#pragma once

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
};

/// Runs `work` in a forked child, in a process group of its own that is killed when `seconds` are over or
/// when an interrupt comes. What it prints goes nowhere but to the last words of a crash. Call without
/// threads running.
Outcome isolate(const std::function<std::string()>& work, double seconds);

}  // namespace plumb::harness
