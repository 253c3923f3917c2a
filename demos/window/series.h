#pragma once

#include <string>
#include <vector>

namespace plumb::window {

/// A figure over the last few seconds.
class Series {
 public:
  Series(std::string name, std::string unit) : name_(std::move(name)), unit_(std::move(unit)) {}

  const std::string& name() const { return name_; }
  const std::string& unit() const { return unit_; }
  double last() const { return samples_.empty() ? 0 : samples_.back().value; }

  /// Adds a sample, and removes those at `time` s or later.
  void add(double time, double value);
  /// Returns the values for a plot, oldest first.
  std::vector<float> values() const;

  static constexpr std::size_t kMost = 300;

 private:
  struct Sample {
    double time, value;
  };
  std::string name_, unit_;
  std::vector<Sample> samples_;
};

}  // namespace plumb::window
