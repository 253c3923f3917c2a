#pragma once

#include <chrono>
#include <string>

#include "harness/compare.h"

namespace plumb::app {

/// One line on stderr that says how far a comparison is and how long it may still take; nothing where stderr
/// is not a terminal.
class ProgressLine {
 public:
  ProgressLine();
  void show(const harness::Progress& progress);
  void say(const std::string& text);
  void clear();

 private:
  using Clock = std::chrono::steady_clock;
  bool on_;
  bool shown_ = false;
  Clock::time_point start_ = Clock::now();
};

}  // namespace plumb::app
