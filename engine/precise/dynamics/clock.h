#pragma once

#include <chrono>

namespace plumb::precise {

/// Adds the time until its end to `nanoseconds`; does nothing, and does not read the clock, unless `on`.
class Clock {
 public:
  Clock(bool on, double& nanoseconds) : sum_(on ? &nanoseconds : nullptr) {
    if (sum_) start_ = std::chrono::steady_clock::now();
  }
  ~Clock() {
    if (sum_)
      *sum_ += std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - start_).count();
  }
  Clock(const Clock&) = delete;
  Clock& operator=(const Clock&) = delete;

 private:
  double* sum_;
  std::chrono::steady_clock::time_point start_{};
};

}  // namespace plumb::precise
