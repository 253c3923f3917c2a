#pragma once

#include <chrono>
#include <string>

#include "harness/compare.h"

namespace plumb::app {

/// One line on stderr with the progress of a comparison and its estimated remaining time. Prints nothing if
/// stderr is not a terminal.
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
